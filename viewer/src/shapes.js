// What is drawn of a shape: one or more parts, each a geometry that equal parts share, its scale, and its place.
import * as THREE from 'three';
import {RoundedBoxGeometry} from 'three/addons/geometries/RoundedBoxGeometry.js';

/// Rounded shapes of so many different sizes get geometries of their own; further ones are drawn with sharp edges.
const kOwnSizes = 64;
const kSegments = 40;

/// Profile of a rounded cylinder or cone from the lower end to the upper one, for a lathe.
function profile(points, rounding, steps) {
  const out = [];
  for (const {x, y, from, to} of points) {
    for (let i = 0; i <= steps; ++i) {
      const angle = from + ((to - from) * i) / steps;
      out.push(new THREE.Vector2(Math.max(0, x + rounding * Math.cos(angle)), y + rounding * Math.sin(angle)));
    }
  }
  return out;
}

function roundCylinder([radius, half, , rounding], detail) {
  const quarter = Math.PI / 2;
  const points = [{x: 0, y: -half, from: -quarter, to: -quarter}, {x: radius, y: -half, from: -quarter, to: 0},
                  {x: radius, y: half, from: 0, to: quarter}, {x: 0, y: half, from: quarter, to: quarter}];
  return new THREE.LatheGeometry(profile(points, rounding, 5), Math.round(kSegments * detail));
}

function roundCone([radius, half, , rounding], detail) {
  const quarter = Math.PI / 2, slope = Math.atan2(radius, 2 * half);
  const points = [{x: 0, y: -half, from: -quarter, to: -quarter}, {x: radius, y: -half, from: -quarter, to: slope},
                  {x: 0, y: half, from: slope, to: quarter}];
  return new THREE.LatheGeometry(profile(points, rounding, 6), Math.round(kSegments * detail));
}

function geometryOf(positions, indices) {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.BufferAttribute(positions, 3));
  geometry.setIndex(new THREE.BufferAttribute(indices, 1));
  return geometry;
}

/// Every triangle with corners and a normal of its own. A mirrored one goes round the other way, so that its outside
/// stays outside.
function flat(surface, mirrored) {
  const geometry = geometryOf(surface.positions, surface.indices).toNonIndexed();
  geometry.computeVertexNormals();
  if (!mirrored) return geometry;
  const {array} = geometry.attributes.position;
  for (let i = 3; i < array.length; i += 9) {
    const second = array.slice(i, i + 3);
    array.copyWithin(i, i + 3, i + 6);
    array.set(second, i + 3);
  }
  return geometry;
}

/// Terrain: neighbours share their corners, and light runs over them.
function smooth(surface) {
  const geometry = geometryOf(surface.positions, surface.indices);
  geometry.computeVertexNormals();
  return geometry;
}

/// A hull swept by a ball: faces moved outwards, a bent strip along each edge, a ball at each vertex.
function roundHull({positions, indices}, [sx, sy, sz, rounding]) {
  const corner = (i) => new THREE.Vector3(positions[3 * i] * sx, positions[3 * i + 1] * sy, positions[3 * i + 2] * sz);
  const points = [], normals = [], edges = new Map();
  const triangle = (list, ns) => list.forEach((p, i) => {
    points.push(...p.clone().addScaledVector(ns[i], rounding).toArray());
    normals.push(...ns[i].toArray());
  });
  const mirrored = sx * sy * sz < 0;
  for (let k = 0; k < indices.length; k += 3) {
    const ids = mirrored ? [indices[k], indices[k + 2], indices[k + 1]] : [indices[k], indices[k + 1], indices[k + 2]];
    const [a, b, c] = ids.map(corner);
    const n = b.clone().sub(a).cross(c.clone().sub(a)).normalize();
    triangle([a, b, c], [n, n, n]);
    [[ids[0], ids[1]], [ids[1], ids[2]], [ids[2], ids[0]]].forEach(([i, j]) => edges.set(`${i},${j}`, {i, j, n}));
  }
  for (const {i, j, n} of edges.values()) {
    const other = edges.get(`${j},${i}`);
    if (!other || i > j || n.dot(other.n) > 0.99999) continue;
    const [p, q] = [corner(i), corner(j)];
    for (let step = 0; step < 4; ++step) {
      const [u, v] = [step / 4, (step + 1) / 4].map((part) => n.clone().lerp(other.n, part).normalize());
      triangle([p, p, q], [u, v, u]);
      triangle([q, p, q], [u, v, v]);
    }
  }
  const ball = new THREE.SphereGeometry(1, 12, 8).toNonIndexed().attributes.position;
  for (let i = 0; i < positions.length / 3; ++i) {
    const at = corner(i);
    for (let k = 0; k < ball.count; k += 3) {
      const ns = [0, 1, 2].map((m) => new THREE.Vector3().fromBufferAttribute(ball, k + m).normalize());
      triangle([at, at, at], ns);
    }
  }
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.BufferAttribute(Float32Array.from(points), 3));
  geometry.setAttribute('normal', new THREE.BufferAttribute(Float32Array.from(normals), 3));
  return geometry;
}

const kPlain = {
  box: () => new THREE.BoxGeometry(2, 2, 2),
  sphere: (detail) => new THREE.SphereGeometry(1, Math.round(36 * detail), Math.round(24 * detail)),
  tube: (detail) => new THREE.CylinderGeometry(1, 1, 2, Math.round(32 * detail), 1, true),
  // A little more than half, so that no gap shows between cap and tube.
  cap: (detail) => new THREE.SphereGeometry(1, Math.round(32 * detail), Math.round(13 * detail), 0, 2 * Math.PI, 0,
                                            0.54 * Math.PI),
  cylinder: (detail) => new THREE.CylinderGeometry(1, 1, 2, Math.round(kSegments * detail)),
  cone: (detail) => new THREE.ConeGeometry(1, 2, Math.round(kSegments * detail)),
};
const kRounded = {
  box: ([x, y, z, r]) => new RoundedBoxGeometry(2 * (x + r), 2 * (y + r), 2 * (z + r), 4, r),
  cylinder: roundCylinder,
  cone: roundCone,
};

export class Parts {
  constructor(surfaces) {
    this.surfaces = surfaces;
    this.own = new Set();
  }

  /// `mesh` names the geometry, `make(detail)` makes it, `skin` names its material.
  of(shape) {
    const [x, y, z, rounding] = shape.size;
    const at = (mesh, scale, offset = 0, flip = false) =>
        ({mesh, make: kPlain[mesh], skin: mesh === 'box' ? 'bevelled' : 'striped', scale, offset, flip});
    switch (shape.kind) {
      case 'sphere': return [at('sphere', [x, x, x])];
      case 'capsule': return [at('tube', [x, y, x]), at('cap', [x, x, x], y), at('cap', [x, x, x], -y, true)];
      case 'ellipsoid': return [at('sphere', [x, y, z])];
      case 'box': return [this.rounded(shape) ?? at('box', [x + rounding, y + rounding, z + rounding])];
      case 'cylinder':
      case 'cone': return [this.rounded(shape) ?? at(shape.kind, [x + rounding, y + rounding, x + rounding])];
      case 'hull':
      case 'mesh':
      case 'field': return this.ofSurface(shape);
      default: return [];
    }
  }

  rounded(shape) {
    if (!(shape.size[3] > 0)) return undefined;
    const mesh = `${shape.kind} ${shape.size.join(' ')}`;
    if (!this.own.has(mesh) && this.own.size >= kOwnSizes) return undefined;
    this.own.add(mesh);
    return {mesh, make: (detail) => kRounded[shape.kind](shape.size, detail), skin: 'striped', scale: [1, 1, 1],
            offset: 0, flip: false};
  }

  ofSurface(shape) {
    const surface = this.surfaces[shape.surface];
    if (!surface) return [];
    const [x, y, z, rounding] = shape.size;
    const mirrored = x * y * z < 0;
    const name = `surface ${shape.surface}${mirrored ? ' mirrored' : ''}`;
    const part = {mesh: name, skin: 'plain', scale: [x, y, z], offset: 0, flip: false,
                  make: () => (shape.kind === 'field' ? smooth(surface) : flat(surface, mirrored))};
    if (shape.kind !== 'hull' || !(rounding > 0)) return [part];
    const mesh = `${name} ${shape.size.join(' ')}`;
    if (!this.own.has(mesh) && this.own.size >= kOwnSizes) return [part];
    this.own.add(mesh);
    return [{...part, mesh, scale: [1, 1, 1], make: () => roundHull(surface, shape.size)}];
  }
}

/// Triangles of a grid of heights, cut from corner (c, r) to (c + 1, r + 1); open cells are left out.
export function gridSurface({columns, rows, spacingX, spacingZ, heights, open}) {
  const positions = new Float32Array(3 * columns * rows);
  for (let i = 0; i < columns * rows; ++i) {
    const column = i % columns, row = (i - column) / columns;
    positions[3 * i] = (column - (columns - 1) / 2) * spacingX;
    positions[3 * i + 1] = heights[i];
    positions[3 * i + 2] = (row - (rows - 1) / 2) * spacingZ;
  }
  const indices = [];
  for (let row = 0, cell = 0; row + 1 < rows; ++row) {
    for (let column = 0; column + 1 < columns; ++column, ++cell) {
      if (open.length > 0 && open[cell]) continue;
      const a = row * columns + column, b = a + 1, c = a + columns, d = c + 1;
      indices.push(a, d, b, a, c, d);
    }
  }
  return {positions, indices: Uint32Array.from(indices)};
}
