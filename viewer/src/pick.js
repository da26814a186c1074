// Which body a ray meets first.

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

function meet(shape, o, d) {
  const [x, y] = shape.size;
  if (shape.kind === 'sphere') return meetSphere(o, d, x, 0);
  if (shape.kind === 'capsule') return meetCapsule(o, d, x, y);
  if (shape.kind === 'box') return meetBox(o, d, shape.size);
  return d[1] < 0 ? -o[1] / d[1] : Infinity;
}

/// Index of the body, or -1. A half-space hides what is behind it and is itself never picked.
export function pick(recording, poses, radii, ray) {
  const {origin, direction} = ray;
  const o = [0, 0, 0], d = [0, 0, 0], o2 = [0, 0, 0], d2 = [0, 0, 0];
  let best = Infinity, found = -1;
  for (const shape of recording.shapes) {
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
    const distance = meet(shape, o2, d2);
    if (distance > 0 && distance < best) {
      best = distance;
      found = shape.kind === 'plane' ? -1 : shape.body;
    }
  }
  return found;
}
