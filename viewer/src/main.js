// Opens the page: reads the recording, builds stage and interface, and plays.
import {Bodies} from './bodies.js';
import {bodyRadii, sceneBox} from './bounds.js';
import {Interface, make} from './interface.js';
import {addKeys, addPointer} from './input.js';
import {Labels} from './labels.js';
import {openLive} from './live.js';
import {Marks} from './marks.js';
import {Motion} from './motion.js';
import {pick} from './pick.js';
import {Player} from './player.js';
import {withUnit} from './plots.js';
import {Recording} from './recording.js';
import {SoftBodies} from './soft.js';
import {kSoftRows, softTexts} from './soft_table.js';
import {Stage} from './stage.js';
import * as THREE from 'three';
import style from './style.css';

const kRedrawAfter = 100;  // ms
const kTypes = ['static', 'kinematic', 'dynamic'];
const kRows = ['position', 'turned', 'speed'];

class Viewer {
  constructor(recording) {
    this.recording = recording;
    this.selected = this.hovered = -1;
    this.on = {contacts: false, forces: false, joints: false, frames: false, limits: false, reactions: false,
               names: false, strain: false, wire: false, balls: false, panel: window.innerWidth > 760, loop: true,
               follow: false, theme: window.matchMedia('(prefers-color-scheme: light)').matches, tail: recording.live === true};
    this.radii = bodyRadii(recording);
    this.motion = new Motion(recording);
    const actions = this.makeActions();
    this.interface = new Interface(recording, actions);
    const turn = new THREE.Quaternion();
    turn.setFromUnitVectors(new THREE.Vector3(...recording.up).normalize(), new THREE.Vector3(0, 1, 0));
    this.stage = new Stage(this.interface.view, recording, sceneBox(recording, this.radii, turn));
    this.bodies = new Bodies(recording);
    this.marks = new Marks(recording, this.stage.radius, this.radii);
    this.labels = new Labels(this.interface.overlay, recording, this.radii);
    this.softs = new SoftBodies(recording);
    this.stage.world.add(this.bodies.group, this.softs.group, this.marks.group);
    this.bodies.place(this.motion.now);
    this.softs.update(this.motion.now, false);
    this.player = new Player(this);
    this.actions = actions;
    addKeys(this);
    addPointer(this);
    this.applyTheme();
    this.applyPanel();
    this.interface.press('loop', true);
    this.interface.press('tail', this.on.tail);
    this.interface.showSelection(undefined);
    this.player.setQuality('auto');
    new ResizeObserver(() => this.resize()).observe(this.interface.picture);
    this.stage.controls.addEventListener('change', () => this.player.touch());
    this.resize();
    this.stage.resetView();
    this.player.seek(recording.times[0]);
  }

  makeActions() {
    return {
      seek: (time) => {
        if (this.on.tail) this.set('tail', false);
        this.player.seek(time);
      },
      step: (count) => this.player.step(count),
      togglePlay: () => this.player.setPlaying(!this.player.playing),
      setSpeed: (speed) => { this.player.speed = speed; },
      setQuality: (value) => this.player.setQuality(value),
      resetView: () => this.stage.resetView(),
      lookAtSelected: () => this.lookAtSelected(),
      toggle: (name) => this.set(name, !this.on[name]),
    };
  }

  set(name, on) {
    this.on[name] = on;
    if (name === 'theme') this.applyTheme();
    else if (name === 'panel') this.applyPanel();
    else if (name === 'names') this.labels.all = on;
    else if (name === 'follow') this.showSelection();
    else if (name === 'tail') this.player.setTail(on);
    else if (name === 'balls') this.showBalls(on);
    else if (name === 'strain' || name === 'wire') this.softs.show(name, on);
    else if (name !== 'loop') this.marks.show(name, on);
    this.interface.press(name, on);
    this.player.touch(true);
  }

  showBalls(on) {
    this.bodies.showBalls(on);
    this.bodies.mark(this.selected, this.hovered);
  }

  applyTheme() {
    document.documentElement.classList.toggle('light', this.on.theme);
    this.stage.setTheme(this.on.theme);
    this.bodies.paint(this.on.theme, this.selected, this.hovered);
    this.softs.paint(this.bodies.softColors, this.on.theme);
    this.softs.mark(this.selected, this.hovered);
    for (const plot of this.interface.plots) plot.resize();
  }

  applyPanel() {
    this.interface.root.classList.toggle('wide', !this.on.panel);
    for (const plot of this.interface.plots) plot.resize();
  }

  resize() {
    const {clientWidth, clientHeight} = this.interface.picture;
    if (clientWidth === 0 || clientHeight === 0) return;
    this.stage.resize(clientWidth, clientHeight);
    this.labels.resize(clientWidth, clientHeight);
    this.marks.setPixelRatio(this.stage.renderer.getPixelRatio());
    for (const plot of this.interface.plots) plot.resize();
    this.player.touch(true);
  }

  /// All that depends on the poses shown.
  placeAll() {
    const {motion, recording} = this;
    this.bodies.move(motion.now);
    this.updateSofts();
    this.stage.placePlanes(motion.now);
    this.marks.update(motion);
    if (this.selected >= 0) this.updateSelection();
    this.interface.showTime(this.player.time, motion.frame);
    if (this.interface.couplings.count > 0) {
      const {residuals, off} = recording.reactions(motion.frame);
      this.interface.couplings.show(residuals, off);
    }
    const frame = motion.frame, kept = recording.contactsKept[frame], all = recording.contactsAll[frame];
    const some = kept < all ? `the strongest ${kept} of ${all}` : `${all}`;
    const parts = [];
    if (this.on.contacts || this.on.forces) parts.push(`${some} contact points`);
    if (this.on.reactions) parts.push(`joint forces up to ${withUnit(this.strongestReaction(frame), 'N')}`);
    const text = parts.join('  ·  ');
    if (this.interface.note.textContent !== text) this.interface.note.textContent = text;
  }

  updateSofts() {
    const {on, softs, recording, interface: page} = this;
    if (recording.softs.length === 0) return;
    softs.update(this.motion.now, on.panel);
    if (on.panel) page.softs.show(softs.surfaces, on.strain ? softs.scale : 0);
  }

  strongestReaction(frame) {
    const {forces} = this.recording.reactions(frame);
    let most = 0;
    for (let i = 0; i < forces.length; i += 3) most = Math.max(most, Math.hypot(forces[i], forces[i + 1], forces[i + 2]));
    return most;
  }

  drawLabels() {
    this.labels.draw(this.stage, this.motion.now, this.selected, this.hovered, this.on.theme);
  }

  pick(x, y) {
    return pick(this.recording, this.motion.now, this.radii, this.stage.rayAt(x, y), this.softs, this.on.balls);
  }

  select(body) {
    if (body === this.selected) return;
    this.selected = body;
    this.on.follow = false;
    this.bodies.mark(body, this.hovered);
    this.softs.mark(body, this.hovered);
    this.marks.tracePath(body);
    this.showSelection();
    this.player.touch(true);
  }

  /// A frame that was asked for is here.
  arrived(frame) {
    this.player.arrived();
    if (!this.marks.takesIntoPath(frame) || this.pathTimer) return;
    this.pathTimer = setTimeout(() => {  // many come at once
      this.pathTimer = undefined;
      this.marks.drawPath();
      this.player.touch();
    }, kRedrawAfter);
  }

  hover(body) {
    if (body === this.hovered) return;
    this.hovered = body;
    this.interface.view.classList.toggle('over', body >= 0);
    this.bodies.mark(this.selected, body);
    this.softs.mark(this.selected, body);
    this.player.touch();
  }

  showSelection() {
    const {selected, recording} = this;
    if (selected < 0) return this.interface.showSelection(undefined);
    const soft = recording.softOf(selected);
    const type = soft ? `${soft.cloth ? 'cloth' : 'soft body'}, point ${selected - soft.first}` : kTypes[recording.types[selected]] ?? '';
    this.interface.showSelection({name: recording.labelOf(selected), type, rows: soft ? kSoftRows : kRows,
                                  color: this.bodies.swatch(selected).getStyle(), follow: this.on.follow});
    return this.updateSelection();
  }

  updateSelection() {
    const {motion, recording, selected} = this;
    const k = 7 * selected;
    const position = [0, 1, 2].map((i) => (motion.now[k + i] + recording.origin[i]).toFixed(3)).join('  ');
    const speed = withUnit(motion.speed(selected), 'm/s'), soft = recording.softOf(selected);
    if (soft) {
      const surface = this.softs.surfaces[recording.softs.indexOf(soft)];
      surface.measure();
      return this.interface.updateSelection(softTexts(surface, `${position} m`, speed));
    }
    const angle = (2 * Math.acos(Math.min(1, Math.abs(motion.now[k + 6]))) * 180) / Math.PI;
    return this.interface.updateSelection([`${position} m`, `${angle.toFixed(1)}°`, speed]);
  }

  pointOf(body) {
    return new THREE.Vector3().fromArray(this.motion.now, 7 * body).applyQuaternion(this.stage.world.quaternion);
  }

  lookAtSelected() {
    if (this.selected < 0) return;
    const soft = this.recording.softOf(this.selected);
    const radius = soft ? this.softs.surfaces[this.recording.softs.indexOf(soft)].radius : this.radii[this.selected];
    this.stage.lookAt(this.pointOf(this.selected), radius || 0.1 * this.stage.radius);
  }
}

/// What a test or a user's console may call.
function publish(viewer) {
  const {player, stage, recording} = viewer;
  window.avbdViewer = {
    recording: {bodies: recording.bodyCount, get frames() { return recording.frameCount; }, names: recording.names},
    get finished() { return recording.finished !== false; },
    has: (frame) => recording.has(frame),
    get framesHeld() { return recording.frames?.size ?? recording.frameCount; },
    get pathLines() { return viewer.marks.path.object.geometry.instanceCount; },
    /// Lines that show of joints: axes of frames, limits, where the joint is between them, forces.
    jointLines: () => {
      const {joints} = viewer.marks, count = (segments) => segments.object.geometry.instanceCount;
      return {axes: joints.axes.reduce((sum, segments) => sum + count(segments), 0), limits: count(joints.limits),
              pointers: count(joints.pointers), forces: count(joints.forces)};
    },
    /// Lines of ropes, dots of their wheels, lines between what is coupled.
    couplingLines: () => {
      const {ropes, wheels, lines} = viewer.marks.couplings, count = (segments) => segments.object.geometry.instanceCount;
      return {ropes: count(ropes), wheels: wheels.object.geometry.drawRange.count, lines: count(lines)};
    },
    /// Soft bodies: how they are drawn, and what is measured of them.
    softs: () => viewer.softs.surfaces.map((surface) => ({
      name: surface.soft.name, cloth: surface.soft.cloth, first: surface.soft.first, points: surface.soft.count,
      triangles: surface.indices.length / 3, vertices: surface.vertexPoint.length, lines: surface.wire?.visible === true,
      colored: surface.mesh.material.vertexColors, largest: surface.measure(), volume: surface.volume(),
      restVolume: surface.restVolume})),
    get strainScale() { return viewer.softs.scale; },
    plots: () => viewer.interface.plots.map(({name, high}) => ({name, high})),
    meshes: () => viewer.bodies.sets.map(({mesh, bodies}) => ({
      name: mesh.name, visible: mesh.visible, count: bodies.length, triangles: (mesh.geometry.index ?? mesh.geometry.attributes.position).count / 3,
      transparent: mesh.material.transparent})),
    get time() { return player.time; },
    get frame() { return viewer.motion.frame; },
    get playing() { return player.playing; },
    get selected() { return viewer.selected; },
    get stats() { return player.stats(); },
    get labels() { return viewer.labels.drawn; },
    play: () => player.setPlaying(true),
    pause: () => player.setPlaying(false),
    seek: (time) => player.seek(time),
    select: (body) => viewer.select(body),
    toggle: (name, on) => viewer.set(name, on),
    setQuality: (value) => player.setQuality(value),
    lookAtSelected: () => viewer.lookAtSelected(),
    showBodies: (on) => {
      viewer.bodies.group.visible = viewer.softs.group.visible = on;
      player.touch(true);
    },
    poseOf: (body) => Array.from(viewer.motion.now.subarray(7 * body, 7 * body + 7)),
    colorOf: (body) => viewer.bodies.swatch(body).getHex(),
    /// Where a body's origin is on the page, and which body one sees there.
    project: (body) => {
      const {x, y, z} = stage.project(...viewer.motion.now.subarray(7 * body, 7 * body + 3));
      const {left, top} = viewer.interface.view.getBoundingClientRect();
      const visible = Math.abs(z) < 1 && document.elementFromPoint(x + left, y + top) === viewer.interface.view;
      return {x: x + left, y: y + top, visible, front: viewer.pick(x, y)};
    },
    drawCalls: () => stage.renderer.info.render.calls,
  };
}

function fail(error) {
  console.error(error);
  const reason = `The recording cannot be shown: ${error.message}`;
  document.body.replaceChildren(make('div', {class: 'failure'}, make('h1', {text: document.title}),
                                     make('p', {text: reason}), make('p', {text: 'WebGL 2 is needed.'})));
}

async function start() {
  const sheet = document.createElement('style');
  sheet.textContent = style;
  document.head.append(sheet);
  try {
    const head = JSON.parse(document.getElementById('avbd-head').textContent);
    if (head.live) {
      const recording = await openLive();
      const viewer = new Viewer(recording);
      recording.attach(viewer);
      publish(viewer);
      return;
    }
    const recording = new Recording(head);
    recording.readFrames(document);
    publish(new Viewer(recording));
  } catch (error) {
    fail(error);
  }
}

start();
