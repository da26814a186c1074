// Small plots of a figure against time, with a cursor at the play position.

const kPrefixes = [[1e9, 'G'], [1e6, 'M'], [1e3, 'k'], [1, ''], [1e-3, 'm'], [1e-6, 'µ'], [1e-9, 'n']];

/// The prefix that suits the largest value.
function prefixFor(largest) {
  return kPrefixes.find(([size]) => largest >= size) ?? kPrefixes[largest > 0 ? kPrefixes.length - 1 : 3];
}

export function withUnit(value, unit) {
  if (!Number.isFinite(value)) return '–';
  const [size, prefix] = prefixFor(Math.abs(value));
  return `${Number((value / size).toPrecision(3))} ${prefix}${unit}`;
}

/// A round number of about a third of the span.
function tickStep(span) {
  const rough = span / 3, power = 10 ** Math.floor(Math.log10(rough));
  return [1, 2, 5, 10].map((m) => m * power).find((step) => step >= rough) ?? power;
}

export class Plot {
  constructor(make, {name, title, unit, color, times, values, onSeek}) {
    Object.assign(this, {name, unit, color, times, values, logarithmic: false});
    this.value = make('output', {class: 'value'});
    this.logButton = make('button', {class: 'tiny', type: 'button', title: 'Logarithmic scale', text: 'log'});
    this.canvas = make('canvas', {role: 'img', 'aria-label': `${title} against time`});
    this.cursor = make('div', {class: 'cursor'});
    const box = make('div', {class: 'plotBox'}, this.canvas, this.cursor);
    const swatch = make('i', {class: 'swatch', style: `background:${color}`});
    const heading = make('span', {}, swatch, make('span', {text: title}));
    this.element = make('figure', {class: 'plot'},
                        make('figcaption', {}, heading, this.logButton, this.value), box);
    this.logButton.addEventListener('click', () => {
      this.logarithmic = !this.logarithmic;
      this.logButton.setAttribute('aria-pressed', this.logarithmic);
      this.draw();
    });
    const seek = (event) => {
      const {left} = box.getBoundingClientRect();
      const part = (event.clientX - left - this.left) / (this.width - this.left - this.right);
      onSeek(this.times[0] + Math.min(1, Math.max(0, part)) * this.span);
    };
    box.addEventListener('pointerdown', (event) => {
      box.setPointerCapture(event.pointerId);
      seek(event);
    });
    box.addEventListener('pointermove', (event) => event.buttons & 1 && seek(event));
    this.left = 56;
    this.right = 8;
    this.measure();
  }

  measure() {
    this.span = this.times[this.times.length - 1] - this.times[0] || 1;
    const finite = this.values.filter(Number.isFinite);
    this.high = finite.reduce((a, b) => Math.max(a, b), 0);
    this.low = finite.reduce((a, b) => (b > 0 ? Math.min(a, b) : a), this.high);
  }

  setData(times, values) {
    Object.assign(this, {times, values});
    this.measure();
    if (this.width > 0) this.draw();
  }

  resize() {
    this.width = this.canvas.clientWidth;
    this.height = this.canvas.clientHeight;
    const ratio = window.devicePixelRatio;
    this.canvas.width = Math.round(this.width * ratio);
    this.canvas.height = Math.round(this.height * ratio);
    if (this.width > 0) this.draw();
  }

  xOf(time) {
    return this.left + ((time - this.times[0]) / this.span) * (this.width - this.left - this.right);
  }

  yOf(value) {
    const top = 6, bottom = this.height - 16;
    if (!this.logarithmic) return bottom - (value / (this.high * 1.05 || 1)) * (bottom - top);
    const low = Math.log10(this.floor), high = Math.log10(this.high * 1.2);
    return bottom - ((Math.log10(Math.max(value, this.floor)) - low) / (high - low || 1)) * (bottom - top);
  }

  draw() {
    const pen = this.canvas.getContext('2d'), ratio = window.devicePixelRatio;
    const style = getComputedStyle(this.canvas);
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.clearRect(0, 0, this.width, this.height);
    pen.font = '10px system-ui, sans-serif';
    pen.fillStyle = style.getPropertyValue('--quiet');
    pen.strokeStyle = style.getPropertyValue('--line');
    pen.lineWidth = 1;
    this.floor = Math.max(this.low * 0.8, this.high * 1e-9, 1e-30);
    this.drawLevels(pen);
    this.drawTimes(pen);
    this.drawLine(pen);
    if (this.lastTime !== undefined) this.setCursor(this.lastTime, this.lastFrame);
  }

  drawLevels(pen) {
    const [size, prefix] = prefixFor(this.high);
    const levels = [];
    if (this.logarithmic && this.high > 0) {
      const first = Math.ceil(Math.log10(this.floor)), last = Math.floor(Math.log10(this.high * 1.2));
      const stride = Math.max(1, Math.ceil((last - first) / 3));
      for (let power = first; power <= last; power += stride) levels.push([10 ** power, withUnit(10 ** power, '')]);
    } else {
      const step = this.high > 0 ? tickStep(this.high) : 1;
      for (let i = 0; i * step <= this.high * 1.05 + 1e-30 && i < 8; ++i) {
        levels.push([i * step, i === 0 ? '0' : `${Number(((i * step) / size).toPrecision(3))} ${prefix}${this.unit}`]);
      }
    }
    pen.textAlign = 'right';
    pen.textBaseline = 'middle';
    for (const [value, text] of levels) {
      const y = Math.round(this.yOf(value)) + 0.5;
      pen.beginPath();
      pen.moveTo(this.left, y);
      pen.lineTo(this.width - this.right, y);
      pen.stroke();
      pen.fillText(text, this.left - 5, y);
    }
  }

  drawTimes(pen) {
    const step = tickStep(this.span);
    pen.textBaseline = 'alphabetic';
    pen.textAlign = 'center';
    for (let time = Math.ceil(this.times[0] / step) * step; time <= this.times[0] + this.span; time += step) {
      const x = this.xOf(time);
      if (x < this.width - 14) pen.fillText(`${Number(time.toPrecision(6))} s`, x, this.height - 3);
    }
  }

  /// Many frames fall on one pixel: its lowest and highest value are drawn.
  drawLine(pen) {
    pen.strokeStyle = this.color;
    pen.lineWidth = 1.5;
    pen.lineJoin = 'round';
    pen.beginPath();
    let open = false, column = -1, low = 0, high = 0;
    const flush = () => {
      if (column < 0) return;
      pen[open ? 'lineTo' : 'moveTo'](column, this.yOf(low));
      if (high > low) pen.lineTo(column, this.yOf(high));
      open = true;
    };
    this.values.forEach((value, i) => {
      if (!Number.isFinite(value)) {
        flush();
        open = false;
        column = -1;
        return;
      }
      const x = Math.round(2 * this.xOf(this.times[i])) / 2;
      if (x !== column) {
        flush();
        [column, low, high] = [x, value, value];
      } else {
        [low, high] = [Math.min(low, value), Math.max(high, value)];
      }
    });
    flush();
    pen.stroke();
  }

  setCursor(time, frame) {
    this.lastTime = time;
    this.lastFrame = frame;
    this.cursor.style.transform = `translateX(${this.xOf(time).toFixed(1)}px)`;
    const text = withUnit(this.values[frame], this.unit);
    if (this.value.textContent !== text) this.value.textContent = text;
  }
}
