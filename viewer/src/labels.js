// Body names over the picture: the selected and hovered one, and on demand the nearest.

const kLabels = 200;
const kCell = 12;  // pixels of the grid that keeps labels apart

export class Labels {
  constructor(canvas, recording, radii) {
    Object.assign(this, {canvas, recording, radii, all: false});
    this.pen = canvas.getContext('2d');
    this.drawn = 0;
  }

  resize(width, height) {
    const ratio = window.devicePixelRatio;
    this.width = width;
    this.height = height;
    this.canvas.width = Math.round(width * ratio);
    this.canvas.height = Math.round(height * ratio);
  }

  /// All bodies, and of each soft body one point of its surface.
  named() {
    const {solidBodies, softs} = this.recording;
    const points = softs.filter(({surface}) => surface.length > 0)
                       .map(({first, surface}) => first + surface[surface.length >> 1]);
    return [...Array(solidBodies).keys(), ...points];
  }

  /// Bodies to name, the most important first.
  candidates(stage, poses, selected, hovered) {
    const {recording, radii} = this;
    const chosen = [...new Set([selected, hovered])].filter((body) => body >= 0);
    if (!this.all) return chosen;
    const near = [];
    for (const body of this.named()) {
      if (radii[body] === 0 || chosen.includes(body)) continue;
      const {x, y, z} = stage.project(poses[7 * body], poses[7 * body + 1], poses[7 * body + 2]);
      if (Math.abs(z) < 1 && x > 0 && y > 0 && x < this.width && y < this.height) near.push({body, z});
    }
    near.sort((a, b) => a.z - b.z);
    return chosen.concat(near.map((item) => item.body));
  }

  draw(stage, poses, selected, hovered, light) {
    const {pen, canvas, recording, radii} = this;
    const ratio = window.devicePixelRatio;
    const busy = this.all || selected >= 0 || hovered >= 0;
    if (!busy && this.drawn === 0) return;
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.clearRect(0, 0, canvas.width, canvas.height);
    pen.font = '500 11.5px system-ui, -apple-system, "Segoe UI", Roboto, sans-serif';
    pen.textAlign = 'center';
    pen.textBaseline = 'middle';
    const taken = new Set();
    this.drawn = 0;
    for (const body of this.candidates(stage, poses, selected, hovered)) {
      if (this.drawn >= kLabels) break;
      const at = stage.project(poses[7 * body], poses[7 * body + 1], poses[7 * body + 2]);
      if (Math.abs(at.z) > 1) continue;
      const strong = body === selected || body === hovered;
      const lift = strong ? this.liftOf(stage, poses, body, radii[body]) : 0;
      this.drawOne(recording.labelOf(body), at.x, at.y - lift, strong, body === selected, light, taken);
    }
  }

  /// Pixels that put a label above its body.
  liftOf(stage, poses, body, radius) {
    const up = stage.worldUp;
    const k = 7 * body;
    const base = stage.project(poses[k], poses[k + 1], poses[k + 2]);
    const top = stage.project(poses[k] + up.x * radius, poses[k + 1] + up.y * radius, poses[k + 2] + up.z * radius);
    return Math.min(Math.abs(base.y - top.y), 0.3 * this.height) + 14;
  }

  drawOne(text, x, y, strong, selected, light, taken) {
    const {pen} = this;
    const shown = text.length > 40 ? `${text.slice(0, 38)}…` : text;
    const width = pen.measureText(shown).width + 12, height = 18;
    const cells = [];
    for (let i = Math.floor((x - width / 2) / kCell); i <= Math.floor((x + width / 2) / kCell); ++i) {
      for (let j = Math.floor((y - height / 2) / kCell); j <= Math.floor((y + height / 2) / kCell); ++j) {
        cells.push(i * 4096 + j);
      }
    }
    if (!strong && cells.some((cell) => taken.has(cell))) return;
    for (const cell of cells) taken.add(cell);
    pen.fillStyle = selected ? '#e0630a' : light ? 'rgba(255,255,255,0.86)' : 'rgba(16,21,28,0.8)';
    pen.beginPath();
    pen.roundRect(x - width / 2, y - height / 2, width, height, 5);
    pen.fill();
    pen.fillStyle = selected ? '#ffffff' : light ? '#1d2733' : '#e6edf5';
    pen.fillText(shown, x, y + 0.5);
    ++this.drawn;
  }
}
