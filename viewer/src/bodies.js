// The bodies as instanced meshes: one draw call for all boxes, one for all spheres, one for each hull or mesh.
import * as THREE from 'three';
import {bevelled, plain, striped} from './materials.js';
import {Parts} from './shapes.js';

const kPalette = [0x4e8fd0, 0xe8a04c, 0x53b08a, 0xd9695f, 0x8f7fd1, 0xe3c657, 0x58b4c4, 0xd389b4, 0x93ad5a, 0xb98e6d];

function hashOf(text) {
  let hash = 2166136261;
  for (let i = 0; i < text.length; ++i) hash = Math.imul(hash ^ text.charCodeAt(i), 16777619);
  hash ^= hash >>> 15;
  hash = Math.imul(hash, 0x2c1b3c6d);
  return (hash ^ (hash >>> 12)) >>> 0;
}

/// The same colour for the same name in every recording.
function colorOfName(name) {
  const hash = hashOf(name);
  const color = new THREE.Color(kPalette[hash % kPalette.length]);
  return color.offsetHSL(0, 0, (((hash >>> 8) % 64) / 63 - 0.5) * 0.07);
}

function colorOf(recording, body, light) {
  if (recording.types[body] === 0) return new THREE.Color(light ? 0xb4bcc6 : 0x727c89);
  return colorOfName(recording.nameOf(body));
}

const kFlip = new THREE.Quaternion(1, 0, 0, 0);

function partPose(shape, part) {
  const rotation = new THREE.Quaternion(...shape.rotation);
  if (rotation.lengthSq() < 1e-9) rotation.identity();
  rotation.normalize();
  const position = new THREE.Vector3(0, part.offset, 0).applyQuaternion(rotation);
  position.add(new THREE.Vector3(...shape.position));
  if (part.flip) rotation.multiply(kFlip);
  return [...position.toArray(), ...rotation.toArray()];
}

/// Round shapes get fewer triangles the more of them there are.
const detailFor = (count) => (count < 150 ? 1 : count < 600 ? 0.7 : count < 1500 ? 0.5 : 0.4);
const kSkins = {bevelled, striped, plain};

class Instances {
  constructor(name, items, recording) {
    // Those that move come first, so that only their part is sent to the GPU.
    items.sort((a, b) => (recording.tracks[a.body] < 0) - (recording.tracks[b.body] < 0));
    this.bodies = Uint32Array.from(items, (item) => item.body);
    this.movers = items.filter((item) => recording.tracks[item.body] >= 0).length;
    this.colors = items.map(({color}) => (color === undefined ? undefined : new THREE.Color(color)));  // the file's own
    this.scales = Float32Array.from(items.flatMap((item) => item.scale));
    this.poses = Float32Array.from(items.flatMap((item) => item.pose));
    this.plain = Uint8Array.from(items, ({pose}) => (pose.slice(0, 6).every((value) => value === 0) ? 1 : 0));
    const {make, skin, trigger, ball} = items[0];
    this.ball = ball;
    this.make = make;
    this.skin = skin;
    this.materials = [kSkins[skin](false), kSkins[skin](true)];
    if (trigger) {
      for (const material of this.materials) Object.assign(material, {transparent: true, opacity: 0.3, depthWrite: false});
    }
    this.mesh = new THREE.InstancedMesh(undefined, this.materials[1], items.length);
    this.mesh.instanceMatrix.setUsage(THREE.DynamicDrawUsage);
    this.mesh.instanceColor = new THREE.InstancedBufferAttribute(new Float32Array(3 * items.length), 3);
    this.mesh.castShadow = this.mesh.receiveShadow = !trigger;
    if (trigger) this.mesh.renderOrder = 5;
    this.mesh.frustumCulled = false;
    this.mesh.name = name;
  }

  setDetail(detail) {
    if (this.detail === detail) return;
    this.detail = detail;
    this.mesh.geometry.dispose();
    this.mesh.geometry = this.make(detail);
    if (this.skin !== 'bevelled') return;
    this.mesh.geometry.setAttribute('halfSize', new THREE.InstancedBufferAttribute(this.scales, 3));
  }

  update(poses, from, to) {
    const matrices = this.mesh.instanceMatrix.array;
    for (let i = from; i < to; ++i) {
      const b = 7 * this.bodies[i], s = 7 * i, m = 16 * i;
      let px = poses[b], py = poses[b + 1], pz = poses[b + 2];
      let x = poses[b + 3], y = poses[b + 4], z = poses[b + 5], w = poses[b + 6];
      if (!this.plain[i]) {
        const l = this.poses;
        const tx = 2 * (y * l[s + 2] - z * l[s + 1]), ty = 2 * (z * l[s] - x * l[s + 2]);
        const tz = 2 * (x * l[s + 1] - y * l[s]);
        px += l[s] + w * tx + y * tz - z * ty;
        py += l[s + 1] + w * ty + z * tx - x * tz;
        pz += l[s + 2] + w * tz + x * ty - y * tx;
        const [lx, ly, lz, lw] = [l[s + 3], l[s + 4], l[s + 5], l[s + 6]];
        const [ax, ay, az, aw] = [x, y, z, w];
        x = aw * lx + ax * lw + ay * lz - az * ly;
        y = aw * ly - ax * lz + ay * lw + az * lx;
        z = aw * lz + ax * ly - ay * lx + az * lw;
        w = aw * lw - ax * lx - ay * ly - az * lz;
      }
      const sx = this.scales[3 * i], sy = this.scales[3 * i + 1], sz = this.scales[3 * i + 2];
      matrices[m] = (1 - 2 * (y * y + z * z)) * sx;
      matrices[m + 1] = 2 * (x * y + w * z) * sx;
      matrices[m + 2] = 2 * (x * z - w * y) * sx;
      matrices[m + 4] = 2 * (x * y - w * z) * sy;
      matrices[m + 5] = (1 - 2 * (x * x + z * z)) * sy;
      matrices[m + 6] = 2 * (y * z + w * x) * sy;
      matrices[m + 8] = 2 * (x * z + w * y) * sz;
      matrices[m + 9] = 2 * (y * z - w * x) * sz;
      matrices[m + 10] = (1 - 2 * (x * x + y * y)) * sz;
      matrices[m + 12] = px;
      matrices[m + 13] = py;
      matrices[m + 14] = pz;
      matrices[m + 15] = 1;
    }
    if (to > from) {
      this.mesh.instanceMatrix.addUpdateRange(16 * from, 16 * (to - from));
      this.mesh.instanceMatrix.needsUpdate = true;
    }
  }
}

export class Bodies {
  constructor(recording) {
    this.recording = recording;
    this.group = new THREE.Group();
    this.colors = [];
    this.own = new Map();  // of bodies: the first colour that the file gives one of its shapes
    const items = new Map(), parts = new Parts(recording.surfaces);
    for (const shape of recording.shapes) {
      if (shape.color !== undefined && !this.own.has(shape.body)) this.own.set(shape.body, new THREE.Color(shape.color));
      for (const part of parts.of(shape)) {
        const name = part.mesh + (shape.trigger ? ' trigger' : shape.ball ? ' ball' : '');
        if (!items.has(name)) items.set(name, []);
        items.get(name).push({...part, trigger: shape.trigger, ball: shape.ball, body: shape.body, color: shape.color,
                              pose: partPose(shape, part)});
      }
    }
    this.sets = [...items].map(([name, list]) => new Instances(name, list, recording));
    for (const set of this.sets) this.group.add(set.mesh);
    this.showBalls(false);
  }

  setQuality(most, rich) {
    const {shapes, solidShapes} = this.recording;
    for (const set of this.sets) {
      set.setDetail(Math.min(most, detailFor(set.ball ? shapes.length : solidShapes)));
      set.mesh.material = set.materials[rich ? 1 : 0];
    }
  }

  /// All poses, once; then `move` for those that change.
  place(poses) {
    for (const set of this.sets) set.update(poses, 0, set.bodies.length);
  }

  move(poses) {
    for (const set of this.sets) {
      if (set.mesh.visible) set.update(poses, 0, set.movers);
    }
  }

  /// The balls on points of soft bodies; `mark` and `move` leave out those that do not show.
  showBalls(on) {
    for (const set of this.sets) {
      if (set.ball) set.mesh.visible = on;
    }
  }

  /// Colours by theme, with the selected and hovered body picked out.
  paint(light, selected, hovered) {
    const {recording} = this;
    this.colors = recording.names.slice(0, recording.solidBodies).map((_, body) => colorOf(recording, body, light));
    this.softColors = recording.softs.map(
        ({name, color}) => (color === undefined ? colorOfName(name) : new THREE.Color(color)));
    recording.softs.forEach(({count}, i) => {
      for (let k = 0; k < count; ++k) this.colors.push(this.softColors[i]);
    });
    this.light = light;
    this.mark(selected, hovered);
  }

  swatch(body) {
    return this.own.get(body) ?? this.colors[body];
  }

  mark(selected, hovered) {
    const accent = new THREE.Color(0xff7a1a), white = new THREE.Color(0xffffff), color = new THREE.Color();
    for (const set of this.sets) {
      if (!set.mesh.visible) continue;
      set.bodies.forEach((body, i) => {
        color.copy(set.colors[i] ?? this.colors[body]);
        if (body === selected) color.lerp(accent, 0.85);
        else if (body === hovered) color.lerp(white, 0.3);
        color.toArray(set.mesh.instanceColor.array, 3 * i);
      });
      set.mesh.instanceColor.needsUpdate = true;
    }
  }
}
