// Reads what page.cpp wrote: the JSON head and the frames' bytes.
import {gridSurface} from './shapes.js';
import * as THREE from 'three';

const kPoseBytes = 15;
const kPlaceBytes = 9;
const kContactBytes = 13;
const kJointBytes = 4;
const kResidualBytes = 4;
const kJointOff = 65535;
/// One number for each frame, in the order in which they are sent.
export const kFigures = ['energy', 'penetration', 'gap', 'excess', 'excessAngle'];
export const kKinds =
    ['sphere', 'capsule', 'box', 'plane', 'cylinder', 'cone', 'ellipsoid', 'hull', 'mesh', 'field'];
export const kWorld = 0xffffffff;
const kDynamic = 2;
const kNoTrack = 0x7fffffff;  // of points, which move, but have none of the tracks

function joined(a, b) {
  const out = new a.constructor(a.length + b.length);
  out.set(a);
  out.set(b, a.length);
  return out;
}

function bytesOf(base64) {
  if (Uint8Array.fromBase64) return Uint8Array.fromBase64(base64);
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return bytes;
}

export const numbers = (Type, base64) => new Type(bytesOf(base64).buffer);

/// The three smaller components in 15 bits each; the largest is positive and makes the length one.
function unpackRotation(low, high, out, at) {
  const largest = (high >> 21) & 3;
  const scale = Math.SQRT1_2;
  const a = (((high >> 6) & 0x7fff) / 16383 - 1) * scale;
  const b = ((((high << 9) & 0x7e00) | (low >> 15)) / 16383 - 1) * scale;
  const c = ((low & 0x7fff) / 16383 - 1) * scale;
  const d = Math.sqrt(Math.max(0, 1 - a * a - b * b - c * c));
  // Stored w first, kept as x y z w.
  if (largest === 0) [out[at], out[at + 1], out[at + 2], out[at + 3]] = [a, b, c, d];
  else if (largest === 1) [out[at], out[at + 1], out[at + 2], out[at + 3]] = [d, b, c, a];
  else if (largest === 2) [out[at], out[at + 1], out[at + 2], out[at + 3]] = [b, d, c, a];
  else [out[at], out[at + 1], out[at + 2], out[at + 3]] = [b, c, d, a];
}

/// A direction in two bytes and a size in two.
function unpackForce(bytes, p, out, at) {
  const size = bytes[p + 2] | (bytes[p + 3] << 8);
  if (size === 0 || size === kJointOff) return;
  let u = ((bytes[p] << 24) >> 24) / 127, v = ((bytes[p + 1] << 24) >> 24) / 127;
  const w = 1 - Math.abs(u) - Math.abs(v);
  if (w < 0) [u, v] = [(1 - Math.abs(v)) * (u < 0 ? -1 : 1), (1 - Math.abs(u)) * (v < 0 ? -1 : 1)];
  const force = 2 ** ((size - 1) / 1024 - 20) / Math.hypot(u, v, w);
  out.set([u * force, v * force, w * force], at);
}

/// Where no frame says what joints did.
export const kNoReactions = {forces: new Float32Array(0), off: () => false, residuals: new Float32Array(0)};

export class Recording {
  constructor(head) {
    this.title = head.title || 'AVBD';
    this.up = numbers(Float32Array, head.up);
    this.origin = numbers(Float64Array, head.origin);
    this.report = head.report;
    this.names = head.names;
    this.types = numbers(Uint8Array, head.types);
    this.tracks = numbers(Int32Array, head.tracks);
    this.still = numbers(Float32Array, head.still);
    this.ranges = numbers(Float64Array, head.ranges);
    this.contactRange = numbers(Float64Array, head.contactRange);
    this.surfaces = head.surfaces.map((surface) => this.readSurface(surface));
    this.moving = [];  // of those that are no points of soft bodies
    this.tracks.forEach((track, body) => track >= 0 && this.moving.push(body));
    this.shapes = this.readShapes(head);
    this.solidBodies = this.names.length;
    this.solidShapes = this.shapes.length;
    this.softs = (head.softs ?? []).map((soft) => this.readSoft(soft));
    this.joints = this.readJoints(head);
    this.jointStates = head.jointStates ? numbers(Uint8Array, head.jointStates)[0] === 1 : this.joints.length > 0;
    for (const name of kFigures) this[name] = numbers(Float32Array, head[name]);
    this.times = numbers(Float64Array, head.times);
    this.contactsAll = numbers(Uint32Array, head.contactsAll);
    this.contactsKept = numbers(Uint32Array, head.contactsKept);
    this.bodyCount = this.names.length;
    this.frameCount = this.times.length;
  }

  /// Its points become bodies behind all others, with a ball on each corner of the surface.
  readSoft(head) {
    const points = numbers(Float32Array, head.points), surface = numbers(Uint32Array, head.surface);
    const soft = {name: head.name, cloth: head.cloth, elements: head.elements, points, surface, first: this.names.length,
                  count: points.length / 3, range: head.range && numbers(Float64Array, head.range),
                  color: head.color && (head.color[0] << 16) | (head.color[1] << 8) | head.color[2]};
    const radius = Math.max(0, numbers(Float32Array, head.radius)[0]) || 0;
    for (let i = 0; i < soft.count; ++i) this.names.push(`${soft.name}_${i}`);
    this.types = joined(this.types, new Uint8Array(soft.count).fill(kDynamic));
    this.tracks = joined(this.tracks, new Int32Array(soft.count).fill(kNoTrack));
    for (const point of new Set(surface)) {
      this.shapes.push({body: soft.first + point, kind: 'sphere', size: [radius, 0, 0, 0], surface: -1, trigger: false,
                        color: soft.color, position: [0, 0, 0], rotation: [0, 0, 0, 1], ball: true});
    }
    return soft;
  }

  /// The soft body that a body is a point of.
  softOf(body) {
    return body < this.solidBodies ? undefined : this.softs.find(({first, count}) => body >= first && body < first + count);
  }

  readShapes(head) {
    const bodies = numbers(Uint32Array, head.shapeBodies);
    const kinds = numbers(Uint8Array, head.shapeKinds);
    const sizes = numbers(Float32Array, head.shapeSizes);
    const poses = numbers(Float32Array, head.shapePoses);
    const surfaces = numbers(Int32Array, head.shapeSurfaces);
    const triggers = numbers(Uint8Array, head.shapeTriggers);
    const colors = head.shapeColors ? numbers(Uint8Array, head.shapeColors) : [];
    const clean = (value, otherwise) => (Number.isFinite(value) ? value : otherwise);
    return Array.from(bodies, (body, i) => {
      const pose = Array.from(poses.subarray(7 * i, 7 * i + 7), (value, k) => clean(value, k === 3 ? 1 : 0));
      const [x, y, z, qw, qx, qy, qz] = pose;
      const surface = surfaces[i];
      // Hulls and meshes have a scale, which may be negative.
      const size = Array.from(sizes.subarray(4 * i, 4 * i + 4),
                              (value) => (surface >= 0 ? clean(value, 1) : Math.max(0, clean(value, 0))));
      const [red, green, blue, given] = colors.slice(4 * i, 4 * i + 4);
      const color = given ? (red << 16) | (green << 8) | blue : undefined;
      return {body, color, kind: kKinds[kinds[i]], size, surface, trigger: triggers[i] === 1, position: [x, y, z],
              rotation: [qx, qy, qz, qw]};
    });
  }

  readSurface(surface) {
    if (surface.heights) {
      return gridSurface({...surface, heights: numbers(Float32Array, surface.heights),
                          open: numbers(Uint8Array, surface.open)});
    }
    return {positions: numbers(Float32Array, surface.vertices), indices: numbers(Uint32Array, surface.triangles)};
  }

  /// What is known of joints beyond their anchors; nothing in recordings of an older version.
  readJointForms(head) {
    if (!head.jointTypes) return [];
    const free = numbers(Uint8Array, head.jointFree);
    const limits = numbers(Float32Array, head.jointLimits), cones = numbers(Float32Array, head.jointCones);
    return Array.from(numbers(Uint8Array, head.jointTypes),
                      (type, i) => ({type, name: head.jointNames[i], free: free[i],
                                     limits: limits.subarray(12 * i, 12 * i + 12),
                                     cone: Array.from(cones.subarray(2 * i, 2 * i + 2))}));
  }

  /// What only pulleys, couplings and custom joints have.
  readCouplings(head) {
    if (!head.jointWheels) return [];
    const wheels = numbers(Float64Array, head.jointWheels), ratios = numbers(Float32Array, head.jointRatios);
    const rests = numbers(Float64Array, head.jointRests), more = numbers(Uint32Array, head.jointMoreBodies);
    const wheel = (at) => Array.from(wheels.subarray(at, at + 3), (value, k) => value - this.origin[k]);
    return head.jointTerms.map((text, i) => {
      const flat = numbers(Float64Array, text), terms = [];
      for (let at = 0; at < flat.length; at += 6) {
        terms.push({joint: flat[at], axis: flat[at + 1], factors: Array.from(flat.subarray(at + 2, at + 6))});
      }
      return {terms, wheels: [wheel(6 * i), wheel(6 * i + 3)], ratio: ratios[i], rest: rests[i],
              more: Array.from(more.subarray(2 * i, 2 * i + 2)), family: head.jointFamilies[i]};
    });
  }

  readJoints(head) {
    const couplings = this.readCouplings(head);
    const residuals = head.jointResiduals ? numbers(Uint8Array, head.jointResiduals) : [];
    this.residualCount = 0;
    const forms = this.readJointForms(head);
    const bodies = numbers(Uint32Array, head.jointBodies);
    const anchors = numbers(Float64Array, head.jointAnchors);
    const rotations = head.jointTypes ? numbers(Float32Array, head.jointRotations) : undefined;
    const joints = [];
    for (let i = 0; i < bodies.length / 2; ++i) {
      const ends = [0, 1].map((side) => {
        const body = bodies[2 * i + side];
        const anchor = Array.from(anchors.subarray(6 * i + 3 * side, 6 * i + 3 * side + 3));
        const [w, x, y, z] = rotations?.subarray(8 * i + 4 * side, 8 * i + 4 * side + 4) ?? [1, 0, 0, 0];
        const turn = new THREE.Quaternion(x, y, z, w);
        if (!(turn.lengthSq() > 1e-6) || !Number.isFinite(turn.lengthSq())) turn.identity();
        return {body, turn: turn.normalize(), anchor: body === kWorld ? anchor.map((value, k) => value - this.origin[k]) : anchor};
      });
      joints.push({a: ends[0], b: ends[1], name: '', free: 0, limits: [], cone: [], ...forms[i], ...couplings[i],
                   residuals: residuals[i] ?? 0, firstResidual: this.residualCount});
      this.residualCount += residuals[i] ?? 0;
    }
    return joints;
  }

  readFrames(doc) {
    this.places = [];  // of each frame: the chunk, and the offset in it
    let frame = 0;
    for (const element of doc.querySelectorAll('script.avbd-frames')) {
      const bytes = bytesOf(element.textContent);
      element.remove();
      let offset = 0;
      for (const end = Number(element.dataset.end); frame < end; ++frame) {
        this.places.push({bytes, offset});
        offset += this.contactsFrom() + kContactBytes * this.contactsKept[frame];
      }
    }
  }

  /// Of a frame's bytes.
  jointsFrom() {
    return kPoseBytes * this.moving.length + kPlaceBytes * (this.bodyCount - this.solidBodies);
  }

  contactsFrom() {
    const jointBytes = kJointBytes * this.joints.length + kResidualBytes * this.residualCount;
    return this.jointsFrom() + (this.jointStates ? jointBytes : 0);
  }

  /// Whether poses and contacts of a frame are here.
  has() {
    return true;
  }

  /// The same, without asking for anything.
  held() {
    return true;
  }

  /// Asks for single frames.
  request() {}

  /// Poses of a frame, 7 numbers a body: x y z qx qy qz qw about the origin. `stills` writes those that never move.
  poses(frame, out, stills) {
    if (stills) this.stillPoses(out);
    const {bytes, offset} = this.places[frame];
    const {ranges, moving, origin} = this;
    for (let t = 0, p = offset; t < moving.length; ++t, p += kPoseBytes) {
      const at = 7 * moving[t];
      for (let axis = 0; axis < 3; ++axis) {
        const code = bytes[p + 3 * axis] | (bytes[p + 3 * axis + 1] << 8) | (bytes[p + 3 * axis + 2] << 16);
        const range = 6 * t + 2 * axis;
        out[at + axis] = ranges[range] - origin[axis] + code * ranges[range + 1];
      }
      const low = bytes[p + 9] | (bytes[p + 10] << 8) | (bytes[p + 11] << 16);
      const high = bytes[p + 12] | (bytes[p + 13] << 8) | (bytes[p + 14] << 16);
      unpackRotation(low, high, out, at + 3);
    }
    let p = offset + kPoseBytes * moving.length;
    for (const soft of this.softs) p = this.readPlaces(soft, bytes, p, out);
  }

  /// Returns where the next soft body's begin.
  readPlaces({first, count, range}, bytes, from, out) {
    const [x, dx, y, dy, z, dz] = range, [ox, oy, oz] = this.origin;
    let p = from;
    for (let at = 7 * first, end = 7 * (first + count); at < end; at += 7, p += kPlaceBytes) {
      out[at] = x - ox + (bytes[p] | (bytes[p + 1] << 8) | (bytes[p + 2] << 16)) * dx;
      out[at + 1] = y - oy + (bytes[p + 3] | (bytes[p + 4] << 8) | (bytes[p + 5] << 16)) * dy;
      out[at + 2] = z - oz + (bytes[p + 6] | (bytes[p + 7] << 8) | (bytes[p + 8] << 16)) * dz;
    }
    return p;
  }

  /// Of what never moves; points, too, never turn.
  stillPoses(out) {
    let from = 0;
    for (let body = this.solidBodies; body < this.bodyCount; ++body) out[7 * body + 6] = 1;
    for (let body = 0; body < this.solidBodies; ++body) {
      if (this.tracks[body] >= 0) continue;
      const [x, y, z, qw, qx, qy, qz] = this.still.subarray(from, from + 7);
      const length = Math.hypot(qw, qx, qy, qz);
      const turn = length > 1e-6 && Number.isFinite(length) ? [qx, qy, qz, qw].map((q) => q / length) : [0, 0, 0, 1];
      out.set([x, y, z, ...turn], 7 * body);
      from += 7;
    }
  }

  /// Contacts of a frame as two flat lists of 3 numbers each.
  contacts(frame) {
    const count = this.contactsKept[frame];
    const {bytes, offset} = this.places[frame];
    const positions = new Float32Array(3 * count), forces = new Float32Array(3 * count);
    let p = offset + this.contactsFrom();
    for (let i = 0; i < count; ++i, p += kContactBytes) {
      for (let axis = 0; axis < 3; ++axis) {
        const code = bytes[p + 3 * axis] | (bytes[p + 3 * axis + 1] << 8) | (bytes[p + 3 * axis + 2] << 16);
        const [low, step] = [this.contactRange[2 * axis], this.contactRange[2 * axis + 1]];
        positions[3 * i + axis] = low - this.origin[axis] + code * step;
      }
      unpackForce(bytes, p + 9, forces, 3 * i);
    }
    return {positions, forces};
  }

  /// What joints did at a frame: forces on their B, 3 numbers each, which are not enabled, and the residuals of all.
  reactions(frame) {
    if (!this.jointStates) return kNoReactions;
    const {bytes, offset} = this.places[frame];
    const forces = new Float32Array(3 * this.joints.length), from = offset + this.jointsFrom();
    this.joints.forEach((_, i) => unpackForce(bytes, from + kJointBytes * i, forces, 3 * i));
    const off = (i) => bytes[from + kJointBytes * i + 2] === 255 && bytes[from + kJointBytes * i + 3] === 255;
    const view = new DataView(bytes.buffer, bytes.byteOffset + from + kJointBytes * this.joints.length);
    const residuals = Float32Array.from({length: this.residualCount}, (_, i) => view.getFloat32(kResidualBytes * i, true));
    return {forces, off, residuals};
  }

  /// The last frame at or before a time, and how far towards the next one it is.
  frameAt(time) {
    const {times, frameCount} = this;
    if (!(time > times[0])) return {frame: 0, part: 0};
    if (time >= times[frameCount - 1]) return {frame: frameCount - 1, part: 0};
    let low = 0, high = frameCount - 1;
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (times[middle] <= time) low = middle;
      else high = middle;
    }
    return {frame: low, part: (time - times[low]) / (times[high] - times[low] || 1)};
  }

  nameOf(body) {
    return this.names[body] || `body ${body}`;
  }

  /// Of a point the name of its soft body.
  labelOf(body) {
    return this.softOf(body)?.name ?? this.nameOf(body);
  }
}
