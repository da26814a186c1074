// Which body a ray meets first.

/// A surface of more corners of triangles than this is not searched while the mouse moves.
const kMostCorners = 600000;
/// Of a triangle's size: a ray must not slip between two that share an edge.
const kRim = 1e-5;

/// v turned by the inverse of the quaternion at q[k..k+3], x y z w.
function turnedBack(q, k, vx, vy, vz, out) {
  const x = -q[k], y = -q[k + 1], z = -q[k + 2], w = q[k + 3];
  const tx = 2 * (y * vz - z * vy), ty = 2 * (z * vx - x * vz), tz = 2 * (x * vy - y * vx);
  out[0] = vx + w * tx + y * tz - z * ty;
  out[1] = vy + w * ty + z * tx - x * tz;
  out[2] = vz + w * tz + x * ty - y * tx;
}

function meetSphere(o, d, radius, height) {
  const oy = o[1] - height;
  const b = o[0] * d[0] + oy * d[1] + o[2] * d[2];
  const c = o[0] * o[0] + oy * oy + o[2] * o[2] - radius * radius;
  const root = b * b - c;
  return root < 0 ? Infinity : -b - Math.sqrt(root);
}

function meetBox(o, d, half) {
  let near = -Infinity, far = Infinity;
  for (let i = 0; i < 3; ++i) {
    const a = (-half[i] - o[i]) / d[i], b = (half[i] - o[i]) / d[i];
    near = Math.max(near, Math.min(a, b));
    far = Math.min(far, Math.max(a, b));
  }
  return near <= far ? near : Infinity;
}

function meetCapsule(o, d, radius, half) {
  let best = Math.min(meetSphere(o, d, radius, half), meetSphere(o, d, radius, -half));
  const a = d[0] * d[0] + d[2] * d[2], b = o[0] * d[0] + o[2] * d[2];
  const root = b * b - a * (o[0] * o[0] + o[2] * o[2] - radius * radius);
  if (a > 1e-12 && root >= 0) {
    const along = (-b - Math.sqrt(root)) / a;
    if (Math.abs(o[1] + along * d[1]) <= half) best = Math.min(best, along);
  }
  return best;
}

/// A solid between y = -half and half whose radius runs from `low` to `high`: a cylinder or a cone.
function meetTurned(o, d, low, high, half) {
  let best = Infinity;
  const slope = (high - low) / (2 * half), middle = (high + low) / 2;
  const ro = middle + slope * o[1], rd = slope * d[1];
  const a = d[0] * d[0] + d[2] * d[2] - rd * rd, b = o[0] * d[0] + o[2] * d[2] - ro * rd;
  const c = o[0] * o[0] + o[2] * o[2] - ro * ro, root = b * b - a * c;
  if (root >= 0 && Math.abs(a) > 1e-12) {
    for (const sign of [-1, 1]) {
      const along = (-b + sign * Math.sqrt(root)) / a;
      if (along > 0 && Math.abs(o[1] + along * d[1]) <= half) best = Math.min(best, along);
    }
  }
  for (const [y, radius] of [[-half, low], [half, high]]) {
    const along = (y - o[1]) / d[1];
    if (along > 0 && Math.hypot(o[0] + along * d[0], o[2] + along * d[2]) <= radius) best = Math.min(best, along);
  }
  return best;
}

/// Möller and Trumbore, "Fast, minimum storage ray-triangle intersection", 1997; from both sides.
export function meetTriangle(o, d, p, i, j, k) {
  const ax = p[3 * i], ay = p[3 * i + 1], az = p[3 * i + 2];
  const ux = p[3 * j] - ax, uy = p[3 * j + 1] - ay, uz = p[3 * j + 2] - az;
  const vx = p[3 * k] - ax, vy = p[3 * k + 1] - ay, vz = p[3 * k + 2] - az;
  const hx = d[1] * vz - d[2] * vy, hy = d[2] * vx - d[0] * vz, hz = d[0] * vy - d[1] * vx;
  const det = ux * hx + uy * hy + uz * hz;
  const sx = o[0] - ax, sy = o[1] - ay, sz = o[2] - az;
  const u = (sx * hx + sy * hy + sz * hz) / det;
  if (!(u >= -kRim && u <= 1 + kRim)) return Infinity;
  const qx = sy * uz - sz * uy, qy = sz * ux - sx * uz, qz = sx * uy - sy * ux;
  const v = (d[0] * qx + d[1] * qy + d[2] * qz) / det;
  if (!(v >= -kRim && u + v <= 1 + kRim)) return Infinity;
  return (vx * qx + vy * qy + vz * qz) / det;
}

function meetSurface(surface, o, d, [x, y, z]) {
  if (!surface || surface.indices.length > kMostCorners) return Infinity;
  const so = [o[0] / x, o[1] / y, o[2] / z], sd = [d[0] / x, d[1] / y, d[2] / z];
  const {positions, indices} = surface;
  let best = Infinity;
  for (let i = 0; i < indices.length; i += 3) {
    const along = meetTriangle(so, sd, positions, indices[i], indices[i + 1], indices[i + 2]);
    if (along > 0 && along < best) best = along;
  }
  return best;
}

function meetEllipsoid(o, d, half) {
  const so = o.map((value, i) => value / half[i]), sd = d.map((value, i) => value / half[i]);
  const size = Math.hypot(...sd);
  return meetSphere(so, sd.map((value) => value / size), 1, 0) / size;
}

function meet(shape, surfaces, o, d) {
  const [x, y, z, r] = shape.size;
  if (shape.kind === 'sphere') return meetSphere(o, d, x, 0);
  if (shape.kind === 'capsule') return meetCapsule(o, d, x, y);
  if (shape.kind === 'box') return meetBox(o, d, [x + r, y + r, z + r]);
  if (shape.kind === 'cylinder') return meetTurned(o, d, x + r, x + r, y + r);
  if (shape.kind === 'cone') return meetTurned(o, d, x + r, r, y + r);
  if (shape.kind === 'ellipsoid') return meetEllipsoid(o, d, [x, y, z]);
  if (shape.kind !== 'plane') return meetSurface(surfaces[shape.surface], o, d, shape.size);
  return d[1] < 0 ? -o[1] / d[1] : Infinity;
}

/// Index of the body, or -1. A half-space hides what is behind it and is itself never picked. `softs` are met as
/// surfaces, by the nearest of their points, and by their balls where those show.
export function pick(recording, poses, radii, ray, softs, balls) {
  const {origin, direction} = ray;
  const o = [0, 0, 0], d = [0, 0, 0], o2 = [0, 0, 0], d2 = [0, 0, 0];
  let best = Infinity, found = -1;
  for (const shape of recording.shapes) {
    if (shape.trigger || (shape.ball && !balls)) continue;  // of triggers one wants what is in it
    const k = 7 * shape.body;
    const rx = origin.x - poses[k], ry = origin.y - poses[k + 1], rz = origin.z - poses[k + 2];
    if (shape.kind !== 'plane') {
      const b = rx * direction.x + ry * direction.y + rz * direction.z;
      if (b * b < rx * rx + ry * ry + rz * rz - radii[shape.body] ** 2) continue;
    }
    turnedBack(poses, k + 3, rx, ry, rz, o);
    turnedBack(poses, k + 3, direction.x, direction.y, direction.z, d);
    const [px, py, pz] = shape.position;
    turnedBack(shape.rotation, 0, o[0] - px, o[1] - py, o[2] - pz, o2);
    turnedBack(shape.rotation, 0, d[0], d[1], d[2], d2);
    const distance = meet(shape, recording.surfaces, o2, d2);
    if (distance > 0 && distance < best) {
      best = distance;
      found = shape.kind === 'plane' ? -1 : shape.body;
    }
  }
  const soft = softs.meet(origin.toArray(), direction.toArray());
  return soft.distance < best ? soft.body : found;
}
