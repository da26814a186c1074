// The poses shown: between two recorded frames, positions in a line and rotations by normalised interpolation.

export class Motion {
  constructor(recording) {
    this.recording = recording;
    const size = 7 * recording.bodyCount;
    this.now = new Float32Array(size);
    this.before = new Float32Array(size);
    this.after = new Float32Array(size);
    this.frames = [-1, -1];
    this.frame = 0;
    recording.poses(0, this.now, true);
    this.before.set(this.now);
    this.after.set(this.now);
  }

  /// Sets `now` to the poses at a time.
  seek(time) {
    const {recording} = this;
    const {frame, part} = recording.frameAt(time);
    const next = Math.min(frame + 1, recording.frameCount - 1);
    if (this.frames[0] !== frame && this.frames[1] === frame) {
      [this.before, this.after] = [this.after, this.before];
      this.frames = [frame, this.frames[0]];
    }
    // What a live recording has not sent yet is asked for, and what was shown stays.
    if (!recording.has(frame) || !recording.has(next)) return;
    if (this.frames[0] !== frame) recording.poses(frame, this.before, false);
    if (this.frames[1] !== next) recording.poses(next, this.after, false);
    this.frames = [frame, next];
    this.frame = part < 0.5 ? frame : next;
    this.mix(part);
  }

  mix(part) {
    const {before, after, now} = this;
    const rest = 1 - part;
    for (const body of this.recording.moving) {
      const k = 7 * body;
      for (let i = k; i < k + 3; ++i) now[i] = rest * before[i] + part * after[i];
      const along = before[k + 3] * after[k + 3] + before[k + 4] * after[k + 4] + before[k + 5] * after[k + 5] +
          before[k + 6] * after[k + 6];
      const other = along < 0 ? -part : part;
      const x = rest * before[k + 3] + other * after[k + 3], y = rest * before[k + 4] + other * after[k + 4];
      const z = rest * before[k + 5] + other * after[k + 5], w = rest * before[k + 6] + other * after[k + 6];
      const scale = 1 / Math.sqrt(x * x + y * y + z * z + w * w);
      now[k + 3] = x * scale;
      now[k + 4] = y * scale;
      now[k + 5] = z * scale;
      now[k + 6] = w * scale;
    }
    for (let k = 7 * this.recording.solidBodies; k < now.length; k += 7) {  // points of soft bodies do not turn
      now[k] = rest * before[k] + part * after[k];
      now[k + 1] = rest * before[k + 1] + part * after[k + 1];
      now[k + 2] = rest * before[k + 2] + part * after[k + 2];
    }
  }

  /// Mean speed between the two frames around now.
  speed(body) {
    const {times} = this.recording;
    if (this.frames[0] < 0) return 0;
    const step = times[this.frames[1]] - times[this.frames[0]];
    if (!(step > 0)) return this.lastSpeed(body);
    const k = 7 * body;
    return Math.hypot(...[0, 1, 2].map((i) => this.after[k + i] - this.before[k + i])) / step;
  }

  lastSpeed(body) {
    const {times, frameCount} = this.recording;
    if (frameCount < 2 || !this.recording.has(frameCount - 2)) return 0;
    this.scratch ??= new Float32Array(this.now.length);
    this.recording.poses(frameCount - 2, this.scratch, true);
    const k = 7 * body;
    const step = times[frameCount - 1] - times[frameCount - 2];
    return step > 0 ? Math.hypot(...[0, 1, 2].map((i) => this.now[k + i] - this.scratch[k + i])) / step : 0;
  }
}

/// A point given in a body's frame, in the world.
export function placed(poses, body, point, out) {
  const k = 7 * body;
  const [px, py, pz] = point;
  const x = poses[k + 3], y = poses[k + 4], z = poses[k + 5], w = poses[k + 6];
  const tx = 2 * (y * pz - z * py), ty = 2 * (z * px - x * pz), tz = 2 * (x * py - y * px);
  out[0] = poses[k] + px + w * tx + y * tz - z * ty;
  out[1] = poses[k + 1] + py + w * ty + z * tx - x * tz;
  out[2] = poses[k + 2] + pz + w * tz + x * ty - y * tx;
  return out;
}
