// Contact points, force lines, joints and the selected body's path.
import * as THREE from 'three';
import {CouplingMarks, isBodiless, isCoupling} from './couplings.js';
import {placed} from './motion.js';
import {isLoose, JointMarks} from './joints.js';
import {kNoReactions, kWorld} from './recording.js';
import {Dots, Segments} from './segments.js';

const kPathPoints = 3000;
const kPathAsked = 200;  // frames of a live recording that are asked for, to draw a path through

/// Metres of line for a newton: strong forces of the recording get a tenth of the scene's size.
function forceScale(recording, radius) {
  const sizes = [];
  const stride = Math.max(1, Math.floor(recording.frameCount / 24));
  for (let frame = 0; frame < recording.frameCount; frame += stride) {
    if (!recording.held(frame)) continue;
    const {forces} = recording.contacts(frame);
    for (let i = 0; i < forces.length; i += 3) sizes.push(Math.hypot(forces[i], forces[i + 1], forces[i + 2]));
  }
  sizes.sort((a, b) => a - b);
  const strong = sizes[Math.floor(0.95 * (sizes.length - 1))] || 0;
  return strong > 0 ? (0.1 * radius) / strong : 0;
}

export class Marks {
  constructor(recording, radius, radii) {
    this.recording = recording;
    this.radius = radius;
    this.shown = {contacts: false, forces: false, joints: false, frames: false, limits: false, reactions: false};
    this.contacts = new Dots(0xffc531, 8, 12);
    this.forces = new Segments(0xff5a36, 2, 11);
    this.arms = new Segments(0x27c4e8, 2, 9);
    this.gaps = new Segments(0xff2d6f, 3, 10);
    this.anchors = new Dots(0x27c4e8, 9, 12);
    this.path = new Segments(0xff7a1a, 2, 8);
    this.joints = new JointMarks(recording, radius, radii);
    this.couplings = new CouplingMarks(recording);
    this.all = [this.contacts, this.forces, this.arms, this.gaps, this.anchors, this.path, ...this.joints.all,
                ...this.couplings.all];
    this.group = new THREE.Group();
    for (const mark of this.all) this.group.add(mark.object);
    this.frame = -1;
  }

  setPixelRatio(ratio) {
    for (const mark of this.all) {
      if (mark.material.uniforms.ratio) mark.material.uniforms.ratio.value = ratio;
    }
  }

  show(name, on) {
    this.shown[name] = on;
    this.frame = -1;
  }

  update(motion) {
    if (this.frame !== motion.frame) this.updateContacts(motion.frame);
    this.frame = motion.frame;
    const {frames, limits, reactions, joints} = this.shown;
    const state = frames || limits || reactions || joints ? this.recording.reactions(motion.frame) : kNoReactions;
    this.updateJoints(motion.now, state);
    this.joints.update(this.shown, motion.now, state);
    this.couplings.update(joints, motion.now, state.off);
  }

  updateContacts(frame) {
    const {shown} = this;
    const none = {positions: [], forces: []};
    const {positions, forces} = shown.contacts || shown.forces ? this.recording.contacts(frame) : none;
    this.contacts.set(positions, shown.contacts || shown.forces ? positions.length / 3 : 0);
    if (!shown.forces) return this.forces.set([], 0);
    this.scale ||= forceScale(this.recording, this.radius);
    const lines = new Float32Array(2 * positions.length);
    for (let i = 0, k = 0; i < positions.length; i += 3, k += 6) {
      const size = Math.hypot(forces[i], forces[i + 1], forces[i + 2]);
      // One huge force must not draw a line across the picture.
      const scale = this.scale * Math.min(1, (0.5 * this.radius) / (size * this.scale || 1));
      for (let axis = 0; axis < 3; ++axis) {
        lines[k + axis] = positions[i + axis];
        lines[k + 3 + axis] = positions[i + axis] + scale * forces[i + axis];
      }
    }
    return this.forces.set(lines, positions.length / 3);
  }

  /// Those that are enabled: an arm from each body's origin, and what lies between the two anchors.
  updateJoints(poses, reactions) {
    const anchored = (joint, i) => !reactions.off(i) && !isBodiless(joint);
    const joints = this.shown.joints ? this.recording.joints.filter(anchored) : [];
    const arms = [], gaps = [], anchors = [], at = [[0, 0, 0], [0, 0, 0]];
    for (const joint of joints) {
      const ends = [joint.a, joint.b].map(
          ({body, anchor}, side) => (body === kWorld ? anchor : placed(poses, body, anchor, at[side])));
      [joint.a, joint.b].forEach(({body}, side) => {
        if (body !== kWorld) arms.push(...ends[side], ...poses.subarray(7 * body, 7 * body + 3));
      });
      if (!isCoupling(joint)) (isLoose(joint) ? arms : gaps).push(...ends[0], ...ends[1]);
      // A body that a custom joint does not have is no place.
      anchors.push(...ends.filter((_, side) => !isCoupling(joint) || [joint.a, joint.b][side].body !== kWorld).flat());
    }
    this.arms.set(Float32Array.from(arms), arms.length / 6);
    this.gaps.set(Float32Array.from(gaps), gaps.length / 6);
    this.anchors.set(Float32Array.from(anchors), anchors.length / 3);
  }

  /// The way of a body's origin through the whole recording; -1 clears it.
  tracePath(body) {
    const {recording} = this;
    this.traced = body;
    this.stride = Math.max(1, Math.ceil(recording.frameCount / kPathPoints));
    this.awaited = new Set();
    if (body >= 0 && recording.tracks[body] >= 0) {
      const apart = this.stride * Math.ceil(recording.frameCount / this.stride / kPathAsked);
      for (let frame = 0; frame < recording.frameCount; frame += apart) {
        if (!recording.held(frame)) this.awaited.add(frame);
      }
      recording.request(this.awaited);
    }
    this.drawPath();
  }

  /// True for a frame that the path waited for: it is to be drawn again.
  takesIntoPath(frame) {
    return this.awaited?.delete(frame) === true;
  }

  /// Through all frames that are here.
  drawPath() {
    const {recording, traced: body, stride} = this;
    if (body < 0 || recording.tracks[body] < 0) return this.path.set([], 0);
    const poses = new Float32Array(7 * recording.bodyCount), points = [];
    for (let frame = 0; frame < recording.frameCount; frame += stride) {
      if (!recording.held(frame)) continue;
      recording.poses(frame, poses, false);
      points.push(poses.slice(7 * body, 7 * body + 3));
    }
    const lines = new Float32Array(6 * Math.max(points.length - 1, 0));
    for (let i = 0; i + 1 < points.length; ++i) {
      lines.set(points[i], 6 * i);
      lines.set(points[i + 1], 6 * i + 3);
    }
    return this.path.set(lines, lines.length / 6);
  }
}
