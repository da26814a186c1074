// How large bodies and the scene are.
import * as THREE from 'three';

function surfaceRadius({positions}, [x, y, z]) {
  let most = 0;
  for (let i = 0; i < positions.length; i += 3) {
    most = Math.max(most, Math.hypot(positions[i] * x, positions[i + 1] * y, positions[i + 2] * z));
  }
  return most;
}

/// Radius about its origin that holds a shape; 0 for a half-space.
function shapeRadius(shape, surfaces) {
  const [x, y, z, rounding] = shape.size;
  switch (shape.kind) {
    case 'plane': return 0;
    case 'sphere': return x;
    case 'capsule': return x + y;
    case 'box': return Math.hypot(x, y, z) + rounding;
    case 'cylinder':
    case 'cone': return Math.hypot(x, y) + rounding;
    case 'ellipsoid': return Math.max(x, y, z);
    default: return surfaces[shape.surface] ? surfaceRadius(surfaces[shape.surface], shape.size) + rounding : 0;
  }
}

/// Radius about the body's origin that holds its shapes; 0 for a half-space.
export function bodyRadii(recording) {
  const radii = new Float32Array(recording.bodyCount);
  for (const shape of recording.shapes) {
    const own = shapeRadius(shape, recording.surfaces);
    if (own > 0) radii[shape.body] = Math.max(radii[shape.body], Math.hypot(...shape.position) + own);
  }
  return radii;
}

function softBox({first, count}, poses, turn) {
  const box = new THREE.Box3(), point = new THREE.Vector3();
  for (let body = first; body < first + count; ++body) box.expandByPoint(point.fromArray(poses, 7 * body).applyQuaternion(turn));
  return box;
}

/// Box around what happens, y up. Of many bodies the few that fly far off are left out.
export function sceneBox(recording, radii, turn) {
  const last = recording.frameCount - 1;
  const frames = [...new Set([0, 0.25, 0.5, 0.75, 1].map((part) => Math.round(part * last)))];
  const poses = new Float32Array(7 * recording.bodyCount);
  let bodies = recording.moving.filter((body) => radii[body] > 0);
  const all = Array.from({length: recording.solidBodies}, (_, body) => body);
  if (bodies.length + recording.softs.length === 0) bodies = all.filter((body) => radii[body] > 0);
  const lows = [[], [], []], highs = [[], [], []], point = new THREE.Vector3();
  for (const frame of frames) {
    if (!recording.has(frame)) continue;
    recording.poses(frame, poses, true);
    for (const body of bodies) {
      point.fromArray(poses, 7 * body).applyQuaternion(turn);
      point.toArray().forEach((value, axis) => {
        lows[axis].push(value - radii[body]);
        highs[axis].push(value + radii[body]);
      });
    }
    for (const soft of recording.softs.filter(({count}) => count > 0)) {
      const {min, max} = softBox(soft, poses, turn);
      min.toArray().forEach((value, axis) => lows[axis].push(value));
      max.toArray().forEach((value, axis) => highs[axis].push(value));
    }
  }
  if (lows[0].length === 0) return new THREE.Box3(new THREE.Vector3(-2, 0, -2), new THREE.Vector3(2, 2, 2));
  const cut = bodies.length > 20 ? 0.01 : 0;
  const at = (list, part) => list.sort((a, b) => a - b)[Math.round(part * (list.length - 1))];
  return new THREE.Box3(new THREE.Vector3(...lows.map((list) => at(list, cut))),
                        new THREE.Vector3(...highs.map((list) => at(list, 1 - cut))));
}
