// Time: playing, stepping, seeking, and one picture for each change. Keeps the frame rate by lowering the quality.
import {kQualities} from './stage.js';

const kSlow = 36;     // ms between pictures above which the quality goes down
const kJudged = 24;   // pictures in a row before judging

export class Player {
  constructor(viewer) {
    Object.assign(this, {viewer, time: viewer.recording.times[0], playing: false, speed: 1});
    this.moved = this.dirty = true;
    this.updates = [];
    this.gaps = [];
    this.draws = [];
    this.streak = 0;
    this.streakTime = 0;
    this.last = performance.now();
    requestAnimationFrame((now) => this.tick(now));
  }

  get first() { return this.viewer.recording.times[0]; }
  get end() { return this.viewer.recording.times[this.viewer.recording.frameCount - 1]; }

  touch(moved = false) {
    this.dirty = true;
    this.moved ||= moved;
  }

  seek(time) {
    this.time = Math.min(this.end, Math.max(this.first, time));
    this.touch(true);
  }

  /// Stays at the newest frame of a recording that grows.
  setTail(on) {
    if (!on) return;
    this.setPlaying(false);
    this.viewer.on.tail = true;
    this.time = this.end;
    this.touch(true);
  }

  /// A live recording has new frames, or frames that were waited for.
  arrived() {
    if (this.viewer.on.tail) this.time = this.end;
    this.touch(true);
  }

  step(count) {
    this.setPlaying(false);
    const {recording, motion} = this.viewer;
    const {frame, part} = recording.frameAt(this.time);
    // Between two frames a step leads to the nearer one in its direction.
    const from = count < 0 && part > 1e-6 ? frame + 1 : frame;
    const next = Math.min(recording.frameCount - 1, Math.max(0, from + count));
    if (this.viewer.on.tail) this.viewer.set('tail', false);
    this.seek(recording.times[next]);
    return motion;
  }

  setPlaying(on) {
    if (on && this.viewer.on.tail) this.viewer.set('tail', false);
    if (on && this.time >= this.end) this.time = this.first;
    this.playing = on && this.end > this.first;
    this.streak = 0;
    this.viewer.interface.showPlaying(this.playing);
    this.touch(true);
  }

  setQuality(value) {
    this.automatic = value === 'auto';
    this.apply(this.automatic ? this.viewer.stage.firstQuality() : Number(value));
  }

  apply(level) {
    this.viewer.stage.setQuality(level);
    this.viewer.bodies.setQuality(kQualities[level].detail, kQualities[level].rich);
    this.viewer.softs.setQuality(kQualities[level].rich);
    this.viewer.marks.setPixelRatio(this.viewer.stage.renderer.getPixelRatio());
    this.streak = 0;
    this.touch(true);
  }

  advance(seconds) {
    this.time += seconds * this.speed;
    if (this.time < this.end) return;
    if (this.viewer.on.loop) {
      this.time = this.first;
    } else {
      this.time = this.end;
      this.setPlaying(false);
    }
  }

  tick(now) {
    requestAnimationFrame((next) => this.tick(next));
    const {viewer} = this;
    const gap = now - this.last;
    this.last = now;
    if (this.playing) {
      // A hidden page stops; it must not jump ahead when seen again.
      this.advance(Math.min(gap, 250) / 1000);
      this.moved = true;
    }
    viewer.stage.controls.update();
    viewer.hoverNow();
    if (!this.moved && !this.dirty) {
      this.streak = 0;
      return;
    }
    const begin = performance.now();
    const {moved} = this;
    this.moved = this.dirty = false;
    if (moved) this.moveBodies();
    viewer.drawLabels();
    const updated = performance.now();
    viewer.stage.render(moved);
    this.note(gap, updated - begin, performance.now() - updated);
  }

  moveBodies() {
    const {viewer} = this;
    const follow = viewer.on.follow && viewer.selected >= 0;
    const before = follow && viewer.pointOf(viewer.selected);
    viewer.motion.seek(this.time);
    if (follow) {
      const step = viewer.pointOf(viewer.selected).sub(before);
      viewer.stage.camera.position.add(step);
      viewer.stage.controls.target.add(step);
    }
    viewer.placeAll();
  }

  note(gap, update, draw) {
    for (const [list, value] of [[this.updates, update], [this.gaps, gap], [this.draws, draw]]) {
      list.push(value);
      if (list.length > 120) list.shift();
    }
    this.streakTime = this.streak === 0 ? 0 : this.streakTime + gap;
    if (++this.streak > kJudged || (this.streak > 4 && this.streakTime > 1200)) this.judge();
  }

  judge() {
    const mean = this.streakTime / (this.streak - 1);
    this.streak = 0;
    this.viewer.interface.rate.textContent = `${Math.round(1000 / mean)} fps`;
    if (!this.automatic || mean < kSlow) return;
    const next = this.viewer.stage.quality + (mean > 4 * kSlow ? 2 : 1);
    const level = Math.min(next, kQualities.length - 1);
    if (level !== this.viewer.stage.quality) this.apply(level);
  }

  stats() {
    const middle = (list) => [...list].sort((a, b) => a - b)[list.length >> 1] ?? 0;
    const mean = this.gaps.reduce((a, b) => a + b, 0) / (this.gaps.length || 1);
    return {updateMs: middle(this.updates), drawMs: middle(this.draws), gapMs: middle(this.gaps),
            perSecond: mean > 0 ? 1000 / mean : 0, quality: this.viewer.stage.quality};
  }

  resetStats() {
    this.updates = [];
    this.gaps = [];
    this.draws = [];
  }
}
