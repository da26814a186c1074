// A recording that a server sends frame by frame (live.cpp), and that may still grow.
import {kFigures as kFigureNames, kNoReactions, Recording} from './recording.js';

const kAhead = 96;          // frames asked for beyond the one that is shown
const kKept = 256e6;        // bytes of frames kept; the ones not shown for longest go
const kHead = 1, kFigures = 2, kFrame = 3, kReport = 4;
const kFirstLook = [0, 0.25, 0.5, 0.75, 1];  // parts of the recording that tell how large the scene is

function joined(Type, a, first, b) {
  const out = new Type(first + b.length);
  out.set(a.subarray(0, first));
  out.set(b, first);
  return out;
}

/// A joint that is not enabled has a force that is no number.
function reactionsOf(forces, residuals) {
  if (forces.length === 0) return kNoReactions;
  const off = Array.from({length: forces.length / 3}, (_, i) => Number.isNaN(forces[3 * i]));
  return {forces: forces.map((value) => (Number.isNaN(value) ? 0 : value)), off: (i) => off[i], residuals};
}

export class LiveRecording extends Recording {
  constructor(head, socket) {
    super(head);
    this.live = true;
    this.finished = false;
    this.socket = socket;
    this.frames = new Map();
    this.asked = new Map();
  }

  attach(viewer) {
    this.viewer = viewer;
  }

  takeFigures(buffer) {
    const [, first, count, finished] = new Uint32Array(buffer, 0, 4);
    let at = 16;
    const part = (Type) => {
      const list = new Type(buffer.slice(at, at + count * Type.BYTES_PER_ELEMENT));
      at += list.byteLength;
      return list;
    };
    this.times = joined(Float64Array, this.times, first, part(Float64Array));
    for (const name of kFigureNames) this[name] = joined(Float32Array, this[name], first, part(Float32Array));
    for (const name of ['contactsAll', 'contactsKept']) this[name] = joined(Uint32Array, this[name], first, part(Uint32Array));
    this.frameCount = this.times.length;
    this.finished = finished === 1;
    if (!this.viewer) return;
    this.viewer.interface.grow();
    this.viewer.player.arrived();
  }

  takeFrame(buffer) {
    const [, frame, bodies, contacts, joints, residuals, points] = new Uint32Array(buffer, 0, 7);
    let at = 28;
    const part = (count) => {
      const list = new Float32Array(buffer, at, count);
      at += list.byteLength;
      return list;
    };
    const poses = part(7 * bodies), places = part(3 * points), positions = part(3 * contacts), forces = part(3 * contacts);
    this.asked.delete(frame);
    const pushed = part(3 * joints);
    this.frames.set(frame, {poses, places, positions, forces, reactions: reactionsOf(pushed, part(residuals))});
    const most = Math.max(2 * kAhead, Math.floor(kKept / Math.max(1, buffer.byteLength)));
    for (const old of this.frames.keys()) {
      if (this.frames.size <= most) break;
      if (old !== 0) this.frames.delete(old);
    }
    this.viewer?.arrived(frame);
  }

  takeReport(report) {
    this.report = report;
    this.viewer?.interface.showReport();
  }

  held(frame) {
    return this.frames.has(frame);
  }

  request(frames) {
    for (const frame of frames) {
      if (!this.frames.has(frame)) this.ask(frame, frame + 1);
    }
  }

  /// Whether a frame is here; if not, it and the next ones are asked for.
  has(frame) {
    const found = this.frames.get(frame);
    if (found) {
      // Last used, last to go.
      this.frames.delete(frame);
      this.frames.set(frame, found);
    }
    const wanted = Math.min(frame + (found ? kAhead / 2 : 0), this.frameCount - 1);
    if (!this.frames.has(wanted)) this.ask(wanted, Math.min(wanted + kAhead, this.frameCount));
    return Boolean(found);
  }

  ask(first, end) {
    const now = performance.now();
    if (now - (this.asked.get(first) ?? -Infinity) < 2000 || this.socket.readyState !== 1) return;
    let from = first, to = first;
    while (to < end && !this.frames.has(to) && !(now - this.asked.get(to) < 2000)) this.asked.set(to++, now);
    if (to > from) this.socket.send(`get ${from} ${to}`);
  }

  poses(frame, out, stills) {
    if (stills) this.stillPoses(out);
    const {poses, places} = this.frames.get(frame) ?? {};
    if (!poses || poses.length + places.length === 0) return;  // a frame that cannot be read shows as the one before
    for (const body of this.moving) out.set(poses.subarray(7 * body, 7 * body + 7), 7 * body);
    for (let i = 0, to = 7 * this.solidBodies; i < places.length; i += 3, to += 7) {
      out[to] = places[i];
      out[to + 1] = places[i + 1];
      out[to + 2] = places[i + 2];
    }
  }

  contacts(frame) {
    return this.frames.get(frame) ?? {positions: [], forces: []};
  }

  reactions(frame) {
    return this.frames.get(frame)?.reactions ?? kNoReactions;
  }
}

function waiting(text) {
  let note = document.querySelector('.waiting');
  if (!text) return note?.remove();
  if (!note) {
    note = document.createElement('p');
    note.className = 'waiting';
    note.setAttribute('role', 'status');
    document.body.append(note);
  }
  note.textContent = text;
  return note;
}

/// Resolves when there is enough to show. Begins anew when the connection was lost.
export function openLive() {
  return new Promise((resolve) => {
    waiting('Waiting for the first frame …');
    const socket = new WebSocket(`ws://${window.location.host}/stream`);
    socket.binaryType = 'arraybuffer';
    let recording, wanted = [];
    socket.addEventListener('message', ({data}) => {
      const kind = new Uint32Array(data, 0, 1)[0];
      if (kind === kHead) {
        recording = new LiveRecording(JSON.parse(new TextDecoder().decode(data.slice(4))), socket);
        document.title = recording.title;
      } else if (kind === kFigures) {
        recording.takeFigures(data);
        if (wanted.length === 0 && !recording.viewer) {
          const last = recording.frameCount - 1;
          wanted = [...new Set(kFirstLook.map((part) => Math.round(part * last)))];
          for (const frame of wanted) socket.send(`get ${frame} ${frame + 1}`);
        }
      } else if (kind === kReport) {
        recording.takeReport(JSON.parse(new TextDecoder().decode(data.slice(4))));
      } else if (kind === kFrame) {
        recording.takeFrame(data);
        if (!recording.viewer && wanted.length > 0 && wanted.every((frame) => recording.frames.has(frame))) {
          wanted = [];
          waiting('');
          resolve(recording);
        }
      }
    });
    socket.addEventListener('close', () => {
      waiting('The connection is lost; trying again …');
      const again = setInterval(async () => {
        try {
          await fetch(window.location.href, {method: 'HEAD'});
          clearInterval(again);
          window.location.reload();
        } catch {
          // Not back yet.
        }
      }, 1000);
    });
  });
}
