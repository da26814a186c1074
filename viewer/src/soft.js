// Soft bodies: a surface each, with smooth normals, the mesh as lines and the strain as colour on demand.
import * as THREE from 'three';
import {yielding} from './materials.js';
import {meetTriangle} from './pick.js';

const kSharpest = Math.cos((40 * Math.PI) / 180);  // faces of a solid that meet at a larger angle at rest keep their edge
const kMostTriangles = 200000;                     // a surface of more is not searched while the mouse moves
const kLeastScale = 0.001;                         // of strain: below it nothing is to be seen
const [kRed, kBlue] = [[0.84, 0.1, 0.08], [0.1, 0.28, 0.9]];

function crossOf(p, a, b, c, out) {
  const ux = p[b] - p[a], uy = p[b + 1] - p[a + 1], uz = p[b + 2] - p[a + 2];
  const vx = p[c] - p[a], vy = p[c + 1] - p[a + 1], vz = p[c + 2] - p[a + 2];
  out[0] = uy * vz - uz * vy;
  out[1] = uz * vx - ux * vz;
  out[2] = ux * vy - uy * vx;
  return out;
}

/// Corners of the faces: a vertex for each point, or one for each side of an edge that stays sharp.
function verticesOf({points, surface, cloth}) {
  const points3 = [], own = new Map(), indices = new Uint32Array(surface.length), normal = [0, 0, 0];
  for (let i = 0; i < surface.length; i += 3) {
    crossOf(points, 3 * surface[i], 3 * surface[i + 1], 3 * surface[i + 2], normal);
    const size = Math.hypot(...normal) || 1;
    for (let k = i; k < i + 3; ++k) {
      const point = surface[k];
      if (!own.has(point)) own.set(point, []);
      const list = own.get(point);
      let found = list.find(({n}) => cloth || n[0] * normal[0] + n[1] * normal[1] + n[2] * normal[2] >= kSharpest * size);
      if (!found) {
        found = {vertex: points3.length, n: normal.map((value) => value / size)};
        points3.push(point);
        list.push(found);
      }
      indices[k] = found.vertex;
    }
  }
  return {points: Uint32Array.from(points3), indices};
}

/// The surface's edges, each once: pairs of vertices.
function edgesOf(points, indices) {
  const found = new Set(), edges = [];
  for (let i = 0; i < indices.length; i += 3) {
    for (let k = 0; k < 3; ++k) {
      const u = indices[i + k], v = indices[i + ((k + 1) % 3)], a = points[u], b = points[v];
      const key = Math.min(a, b) * 4294967296 + Math.max(a, b);  // below 2^53 for any surface that fits a page
      if (found.has(key)) continue;
      found.add(key);
      edges.push(u, v);
    }
  }
  return Uint32Array.from(edges);
}

class Surface {
  constructor(soft, number) {
    Object.assign(this, {soft, number});
    const {points, indices} = verticesOf(soft);
    this.vertexPoint = points;
    this.indices = indices;
    this.edges = edgesOf(points, indices);
    this.rest = this.restLengths();
    this.positions = new Float32Array(3 * points.length);
    this.normals = new Float32Array(3 * points.length);
    const geometry = new THREE.BufferGeometry();
    const attribute = (list) => new THREE.BufferAttribute(list, 3).setUsage(THREE.DynamicDrawUsage);
    geometry.setAttribute('position', attribute(this.positions));
    geometry.setAttribute('normal', attribute(this.normals));
    geometry.setIndex(new THREE.BufferAttribute(indices, 1));
    this.materials = [yielding(false, soft.cloth), yielding(true, soft.cloth)];
    this.mesh = new THREE.Mesh(geometry, this.materials[1]);
    this.mesh.castShadow = this.mesh.receiveShadow = true;
    this.mesh.frustumCulled = false;
    this.mesh.name = `soft ${number}`;
    this.center = [0, 0, 0];
    this.radius = 0;
    this.largest = 0;
    this.restVolume = this.volumeOf((vertex, axis) => soft.points[3 * points[vertex] + axis]);
  }

  restLengths() {
    const p = this.soft.points, at = this.vertexPoint, rest = new Float32Array(this.edges.length / 2);
    for (let i = 0; i < rest.length; ++i) {
      const a = 3 * at[this.edges[2 * i]], b = 3 * at[this.edges[2 * i + 1]];
      rest[i] = Math.hypot(p[a] - p[b], p[a + 1] - p[b + 1], p[a + 2] - p[b + 2]);
    }
    return rest;
  }

  place(poses) {
    const {positions: p, vertexPoint, soft} = this;
    const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
    for (let i = 0, k = 0; i < vertexPoint.length; ++i, k += 3) {
      const from = 7 * (soft.first + vertexPoint[i]);
      for (let axis = 0; axis < 3; ++axis) {
        const value = poses[from + axis];
        p[k + axis] = value;
        if (value < low[axis]) low[axis] = value;
        if (value > high[axis]) high[axis] = value;
      }
    }
    this.center = low.map((value, axis) => (value + high[axis]) / 2);
    this.radius = Math.hypot(...low.map((value, axis) => high[axis] - value)) / 2;
    this.mesh.geometry.attributes.position.needsUpdate = true;
    this.bend();
  }

  /// Normals of the vertices: those of their faces, by area.
  bend() {
    const {positions: p, normals: n, indices} = this, cross = [0, 0, 0];
    n.fill(0);
    for (let i = 0; i < indices.length; i += 3) {
      const a = 3 * indices[i], b = 3 * indices[i + 1], c = 3 * indices[i + 2];
      const [x, y, z] = crossOf(p, a, b, c, cross);
      n[a] += x; n[a + 1] += y; n[a + 2] += z;
      n[b] += x; n[b + 1] += y; n[b + 2] += z;
      n[c] += x; n[c + 1] += y; n[c + 2] += z;
    }
    for (let k = 0; k < n.length; k += 3) {
      const scale = 1 / (Math.sqrt(n[k] * n[k] + n[k + 1] * n[k + 1] + n[k + 2] * n[k + 2]) || 1);
      n[k] *= scale; n[k + 1] *= scale; n[k + 2] *= scale;
    }
    this.mesh.geometry.attributes.normal.needsUpdate = true;
  }

  /// Of each point the strain of that of its edges which is strained most; `largest` is that of all.
  measure() {
    const {positions: p, edges, rest, vertexPoint, soft} = this;
    this.strain ??= new Float32Array(soft.points.length / 3);
    const {strain} = this;
    strain.fill(0);
    let largest = 0;
    for (let i = 0; i < rest.length; ++i) {
      const u = edges[2 * i], v = edges[2 * i + 1], a = 3 * u, b = 3 * v;
      const x = p[a] - p[b], y = p[a + 1] - p[b + 1], z = p[a + 2] - p[b + 2];
      const own = rest[i] > 0 ? Math.sqrt(x * x + y * y + z * z) / rest[i] - 1 : 0, size = Math.abs(own);
      if (size > Math.abs(strain[vertexPoint[u]])) strain[vertexPoint[u]] = own;
      if (size > Math.abs(strain[vertexPoint[v]])) strain[vertexPoint[v]] = own;
      if (size > Math.abs(largest)) largest = own;
    }
    this.largest = largest;
    return largest;
  }

  /// White where nothing is strained, red where it is stretched by `scale`, blue where pressed.
  tint(scale) {
    const {strain, vertexPoint, mesh} = this;
    if (!mesh.geometry.attributes.color) {
      mesh.geometry.setAttribute('color', new THREE.BufferAttribute(new Float32Array(3 * vertexPoint.length), 3));
    }
    const {color} = mesh.geometry.attributes;
    for (let i = 0; i < vertexPoint.length; ++i) {
      const part = Math.max(-1, Math.min(1, strain[vertexPoint[i]] / scale)), much = Math.abs(part);
      const end = part > 0 ? kRed : kBlue;
      for (let k = 0; k < 3; ++k) color.array[3 * i + k] = 1 - much + much * end[k];
    }
    color.needsUpdate = true;
  }

  /// Of what the surface encloses; `at` gives a vertex' coordinate.
  volumeOf(at) {
    if (this.soft.cloth) return 0;
    let six = 0;
    for (let i = 0; i < this.indices.length; i += 3) {
      const [a, b, c] = [0, 1, 2].map((k) => [0, 1, 2].map((axis) => at(this.indices[i + k], axis)));
      six += a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
    }
    return six / 6;
  }

  /// Of the surface as it is; about its middle, or digits get lost.
  volume() {
    return this.volumeOf((vertex, axis) => this.positions[3 * vertex + axis] - this.center[axis]);
  }

  /// The mesh as lines, made when they are first asked for.
  lines() {
    if (!this.wire) {
      const geometry = new THREE.BufferGeometry();
      geometry.setAttribute('position', this.mesh.geometry.attributes.position);
      geometry.setIndex(new THREE.BufferAttribute(this.edges, 1));
      this.wire = new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({transparent: true, opacity: 0.55}));
      this.wire.frustumCulled = false;
      this.wire.renderOrder = 1;
    }
    return this.wire;
  }

  /// Where a ray first meets it: the distance, and the nearest corner's body.
  meet(o, d) {
    const away = [0, 1, 2].map((i) => o[i] - this.center[i]), {positions, indices, soft} = this;
    const along = away[0] * d[0] + away[1] * d[1] + away[2] * d[2];
    const clear = away[0] ** 2 + away[1] ** 2 + away[2] ** 2 - along * along > this.radius ** 2;
    if (clear || indices.length > 3 * kMostTriangles) return {distance: Infinity};
    let distance = Infinity, face = -1;
    for (let i = 0; i < indices.length; i += 3) {
      const found = meetTriangle(o, d, positions, indices[i], indices[i + 1], indices[i + 2]);
      if (found > 0 && found < distance) [distance, face] = [found, i];
    }
    if (face < 0) return {distance};
    const far = (vertex) => Math.hypot(...[0, 1, 2].map((i) => o[i] + distance * d[i] - positions[3 * vertex + i]));
    const corner = Array.from(indices.subarray(face, face + 3)).sort((a, b) => far(a) - far(b))[0];
    return {distance, body: soft.first + this.vertexPoint[corner]};
  }
}

export class SoftBodies {
  constructor(recording) {
    this.recording = recording;
    this.group = new THREE.Group();
    this.surfaces = recording.softs.map((soft, number) => new Surface(soft, number));
    for (const {mesh} of this.surfaces) this.group.add(mesh);
    this.shown = {strain: false, wire: false};
    this.scale = kLeastScale;
    this.rich = 1;
  }

  /// All that depends on poses. `figures`: the largest strains are wanted though no colour shows them.
  update(poses, figures) {
    for (const surface of this.surfaces) surface.place(poses);
    if (!figures && !this.shown.strain) return;
    for (const surface of this.surfaces) this.scale = Math.max(this.scale, Math.abs(surface.measure()));
    if (!this.shown.strain) return;
    for (const surface of this.surfaces) surface.tint(this.scale);
  }

  /// The scale of colours keeps to the most that was seen since they were switched on.
  show(name, on) {
    this.shown[name] = on;
    if (name === 'strain' && on) this.scale = kLeastScale;
    for (const surface of this.surfaces) {
      if (name !== 'wire' || !(on || surface.wire)) continue;
      const lines = surface.lines();
      lines.material.color.setHex(this.lineColor);
      lines.visible = on;
      this.group.add(lines);
    }
    this.dress();
  }

  setQuality(rich) {
    this.rich = rich ? 1 : 0;
    this.dress();
  }

  dress() {
    for (const surface of this.surfaces) {
      if (this.shown.strain && !surface.mesh.geometry.attributes.color) {
        surface.measure();
        surface.tint(this.scale);
      }
      const material = surface.materials[this.rich];
      if (material.vertexColors !== this.shown.strain) {
        material.vertexColors = this.shown.strain;
        material.needsUpdate = true;
      }
      material.color.copy(this.shown.strain || !surface.color ? new THREE.Color(0xffffff) : surface.color);
      surface.mesh.material = material;
    }
  }

  /// `colors` by number; `mark` picks out those selected and hovered.
  paint(colors, light) {
    this.colors = colors;
    this.lineColor = light ? 0x10151b : 0x0a0e13;
    for (const {wire} of this.surfaces) wire?.material.color.setHex(this.lineColor);
  }

  mark(selected, hovered) {
    const accent = new THREE.Color(0xff7a1a), white = new THREE.Color(0xffffff);
    for (const surface of this.surfaces) {
      const holds = (body) => body >= surface.soft.first && body < surface.soft.first + surface.soft.count;
      surface.color = this.colors[surface.number].clone();
      if (holds(selected)) surface.color.lerp(accent, 0.85);
      else if (holds(hovered)) surface.color.lerp(white, 0.3);
    }
    this.dress();
  }

  /// The nearest surface that a ray meets.
  meet(o, d) {
    let best = {distance: Infinity};
    for (const surface of this.surfaces) {
      const found = surface.meet(o, d);
      if (found.distance < best.distance) best = found;
    }
    return best;
  }

  /// Of all soft bodies; signed.
  get largest() {
    return this.surfaces.reduce((most, {largest}) => (Math.abs(largest) > Math.abs(most) ? largest : most), 0);
  }
}
