// What shows of joints beside their arms: frames, limits, and the forces that they carry.
import * as THREE from 'three';
import {kWorld} from './recording.js';
import {Segments} from './segments.js';

const kTypes = ['ball', 'fixed', 'volume', 'hinge', 'slider', 'd6', 'distance', 'pulley', 'coupling', 'custom'];
const kOriented = ['fixed', 'hinge', 'slider', 'd6'];  // of the others only the points matter
const kMeasured = ['distance', 'pulley', 'coupling'];  // whose limits are no stops of a coordinate of two frames
const kAxisColors = [0xff4d4d, 0x4fd66a, 0x5b8cff];
const kArcStep = Math.PI / 24;
const [kTwist, kSwingY, kSwingZ] = [3, 4, 5];
const kSidesOfHead = 4;  // strokes of an arrow's head

export const typeOf = (joint) => kTypes[joint.type];

/// Whether the two anchors may be apart: the line between them is then no gap.
export function isLoose(joint) {
  return typeOf(joint) === 'distance' || (joint.free & 7) !== 0;
}

export function hasFrames(recording) {
  return recording.joints.some((joint) => kOriented.includes(typeOf(joint)));
}

export function hasLimits(recording) {
  return recording.joints.some((joint) => outlineOf(joint).length > 0);
}

/// Joints with a limit on some of these coordinates.
export function limits(joint, axes) {
  return !kMeasured.includes(typeOf(joint)) &&
      axes.some((i) => (joint.free >> i) & 1 && (Number.isFinite(joint.limits[2 * i]) || Number.isFinite(joint.limits[2 * i + 1])));
}

export const hasCone = (joint) => joint.cone.some(Number.isFinite);

/// Lines through points that come one after the other.
function strip(points, out) {
  for (let i = 0; i + 1 < points.length; ++i) out.push(...points[i], ...points[i + 1]);
}

/// An arc about the origin and a spoke to each stop; `at(angle)` is a point of it. Without a stop on one side it ends
/// after a quarter turn, without a spoke.
function arc(low, high, at, out) {
  const from = Number.isFinite(low) ? low : high - Math.PI / 2;
  const to = Math.min(Number.isFinite(high) ? high : low + Math.PI / 2, from + 2 * Math.PI);
  const steps = Math.max(1, Math.ceil((to - from) / kArcStep));
  strip(Array.from({length: steps + 1}, (_, i) => at(from + ((to - from) * i) / steps)), out);
  if (Number.isFinite(low)) out.push(0, 0, 0, ...at(low));
  if (Number.isFinite(high)) out.push(0, 0, 0, ...at(high));
}

/// A bar along an axis with a stroke across it at each stop; metres, so the joint's size does not matter.
function bar(axis, low, high, size, out) {
  const point = (along, across, side) => [0, 1, 2].map((i) => (i === axis ? along : i === (axis + side) % 3 ? across : 0));
  const from = Number.isFinite(low) ? low : high - 2 * size, to = Number.isFinite(high) ? high : low + 2 * size;
  strip([point(from, 0, 1), point(to, 0, 1)], out);
  for (const stop of [low, high].filter(Number.isFinite)) {
    for (const side of [1, 2]) strip([point(stop, -0.4 * size, side), point(stop, 0.4 * size, side)], out);
  }
}

/// Where frame B's x axis points after a swing by the rotation vector (0, y, z).
function swung(y, z, size) {
  const angle = Math.hypot(y, z), part = angle > 1e-6 ? Math.sin(angle) / angle : 1;
  return [size * Math.cos(angle), size * part * z, -size * part * y];
}

function cone([y, z], size, out) {
  const [wideY, wideZ] = [y, z].map((limit) => Math.min(limit, Math.PI));
  const rim = Array.from({length: 49}, (_, i) => {
    const turn = (i * Math.PI) / 24;
    return swung(wideY * Math.cos(turn), wideZ * Math.sin(turn), size);
  });
  strip(rim, out);
  for (let i = 0; i < 48; i += 6) out.push(0, 0, 0, ...rim[i]);
}

/// The limits of a joint as lines in its frame A, 6 numbers each.
function outlineOf(joint, size = 1) {
  const out = [];
  for (let axis = 0; axis < 3; ++axis) {
    if (limits(joint, [axis])) bar(axis, joint.limits[2 * axis], joint.limits[2 * axis + 1], size, out);
  }
  const range = (axis) => [joint.limits[2 * axis], joint.limits[2 * axis + 1]];
  if (limits(joint, [kTwist])) arc(...range(kTwist), (q) => [0, size * Math.cos(q), size * Math.sin(q)], out);
  if (limits(joint, [kSwingY])) arc(...range(kSwingY), (q) => swung(q, 0, size), out);
  if (limits(joint, [kSwingZ])) arc(...range(kSwingZ), (q) => swung(0, q, size), out);
  if (hasCone(joint)) cone(joint.cone, size, out);
  return out;
}

/// Lines in frame B that show on the outline where the joint is: B's y axis on a twist's arc, its x axis in a swing's.
function pointerOf(joint, size) {
  const out = [];
  if (limits(joint, [kTwist])) out.push(0, 0, 0, 0, size, 0);
  if (limits(joint, [kSwingY, kSwingZ]) || hasCone(joint)) out.push(0, 0, 0, size, 0, 0);
  if (limits(joint, [0, 1, 2])) {
    for (let i = 0; i < 3; ++i) out.push(...[0, 1, 2].map((k) => (k === i ? -0.2 * size : 0)), ...[0, 1, 2].map((k) => (k === i ? 0.2 * size : 0)));
  }
  return out;
}

const axisOf = (axis, size) => [0, 0, 0, ...[0, 1, 2].map((i) => (i === axis ? size : 0))];

export class JointMarks {
  constructor(recording, radius, radii) {
    this.recording = recording;
    this.radius = radius;
    this.axes = kAxisColors.map((color) => new Segments(color, 2.5, 13));
    this.limits = new Segments(0xc8e64a, 2, 9);
    this.pointers = new Segments(0xffffff, 2.5, 10);
    this.forces = new Segments(0xb06cff, 2.5, 14);
    this.all = [...this.axes, this.limits, this.pointers, this.forces];
    this.drawn = recording.joints.map((joint) => this.linesOf(joint, radii));
    this.poseA = new THREE.Matrix4();
    this.poseB = new THREE.Matrix4();
  }

  /// In the joint's own frames. As large as the smaller body, but visible in the whole scene and not all over it.
  linesOf(joint, radii) {
    const sizes = [joint.a.body, joint.b.body].map((body) => (body === kWorld ? 0 : radii[body])).filter((size) => size > 0);
    const size = Math.min(0.2 * this.radius, Math.max(0.04 * this.radius, sizes.length > 0 ? 0.7 * Math.min(...sizes) : 0));
    const oriented = kOriented.includes(typeOf(joint));
    return {axesA: oriented ? [0, 1, 2].map((axis) => axisOf(axis, size)) : undefined,
            axesB: oriented ? [0, 1, 2].map((axis) => axisOf(axis, 0.6 * size)) : undefined,
            outline: outlineOf(joint, size), pointer: pointerOf(joint, size)};
  }

  place(end, poses, out) {
    const local = new THREE.Matrix4().compose(new THREE.Vector3(...end.anchor), end.turn, new THREE.Vector3(1, 1, 1));
    if (end.body === kWorld) return out.copy(local);
    const body = new THREE.Matrix4().compose(new THREE.Vector3().fromArray(poses, 7 * end.body),
                                             new THREE.Quaternion().fromArray(poses, 7 * end.body + 3), new THREE.Vector3(1, 1, 1));
    return out.multiplyMatrices(body, local);
  }

  /// `shown` says which of frames, limits and reactions; `reactions` what the joints did at the frame.
  update(shown, poses, reactions) {
    const lists = {axes: [[], [], []], limits: [], pointers: [], forces: []};
    const busy = shown.frames || shown.limits || shown.reactions;
    if (shown.reactions) this.scale ||= this.forceScale();
    this.recording.joints.forEach((joint, i) => {
      if (!busy || reactions.off(i)) return;
      const lines = this.drawn[i];
      this.place(joint.a, poses, this.poseA);
      this.place(joint.b, poses, this.poseB);
      if (shown.frames && lines.axesA) {
        for (let axis = 0; axis < 3; ++axis) {
          add(lists.axes[axis], lines.axesA[axis], this.poseA);
          add(lists.axes[axis], lines.axesB[axis], this.poseB);
        }
      }
      if (shown.limits) {
        add(lists.limits, lines.outline, this.poseA);
        add(lists.pointers, lines.pointer, this.poseB);
      }
      if (shown.reactions && typeOf(joint) !== 'coupling') this.arrow(lists.forces, reactions.forces.subarray(3 * i, 3 * i + 3));
    });
    this.axes.forEach((segments, axis) => fill(segments, lists.axes[axis]));
    for (const name of ['limits', 'pointers', 'forces']) fill(this[name], lists[name]);
  }

  /// The force on B, from A's anchor on.
  arrow(out, force) {
    const tip = new THREE.Vector3(...force);
    const length = Math.min(tip.length() * this.scale, 0.6 * this.radius);
    if (!(length > 1e-3 * this.radius)) return;
    const along = tip.normalize(), from = new THREE.Vector3().setFromMatrixPosition(this.poseA);
    const end = from.clone().addScaledVector(along, length), head = Math.min(0.3 * length, 0.03 * this.radius);
    out.push(...from.toArray(), ...end.toArray());
    const side = new THREE.Vector3(Math.abs(along.x) < 0.8 ? 1 : 0, Math.abs(along.x) < 0.8 ? 0 : 1, 0).cross(along).normalize();
    for (let i = 0; i < kSidesOfHead; ++i) {
      out.push(...end.toArray(), ...end.clone().addScaledVector(along, -head).addScaledVector(side, 0.45 * head).toArray());
      side.applyAxisAngle(along, (2 * Math.PI) / kSidesOfHead);
    }
  }

  /// Metres of arrow for a newton: strong forces get a quarter of the scene's radius.
  forceScale() {
    const {recording, radius} = this, sizes = [];
    const stride = Math.max(1, Math.floor(recording.frameCount / 24));
    for (let frame = 0; frame < recording.frameCount; frame += stride) {
      if (!recording.held(frame)) continue;
      const {forces} = recording.reactions(frame);
      for (let i = 0; i < forces.length; i += 3) sizes.push(Math.hypot(forces[i], forces[i + 1], forces[i + 2]));
    }
    const sorted = sizes.filter((size) => size > 0).sort((a, b) => a - b);
    const strong = sorted[Math.floor(0.95 * (sorted.length - 1))];
    return strong > 0 ? (0.25 * radius) / strong : 0;
  }
}

function add(out, lines, matrix) {
  const m = matrix.elements;
  for (let i = 0; i < lines.length; i += 3) {
    const x = lines[i], y = lines[i + 1], z = lines[i + 2];
    out.push(m[0] * x + m[4] * y + m[8] * z + m[12], m[1] * x + m[5] * y + m[9] * z + m[13],
             m[2] * x + m[6] * y + m[10] * z + m[14]);
  }
}

const fill = (segments, list) => segments.set(Float32Array.from(list), list.length / 6);
