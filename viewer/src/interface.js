// The page around the picture: title, toolbar, transport, panel. It holds no state of the run, only elements.
import {CouplingTable} from './couplings.js';
import {hasCone, hasFrames, hasLimits, limits} from './joints.js';
import {Plot} from './plots.js';
import {SoftTable} from './soft_table.js';

/// An element: attributes by name, `text` for its text, then its children.
export function make(tag, attributes = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (name === 'text') element.textContent = value;
    else if (value !== undefined && value !== false) element.setAttribute(name, value);
  }
  element.append(...children.filter(Boolean));
  return element;
}

const kIcons = {
  play: 'M7 4.5v15l13-7.5z',
  pause: 'M6 4.5h4.5v15H6zM13.5 4.5H18v15h-4.5z',
  back: 'M17.5 5v14L8 12zM5.5 5H8v14H5.5z',
  forward: 'M6.5 5v14l9.5-7zM16 5h2.5v14H16z',
  loop: 'M7 7h9.2l-2-2L15.6 3.6 20 8l-4.4 4.4-1.4-1.4 2-2H8.5A1.5 1.5 0 0 0 7 10.5V12H5v-2.5A2.5 2.5 0 0 1 7 7zM17 17H7.8l2 2-1.4 1.4L4 16l4.4-4.4 1.4 1.4-2 2h7.7a1.5 1.5 0 0 0 1.5-1.5V12h2v2.5a2.5 2.5 0 0 1-2 2.5z',
  home: 'M4 4h6v2H6v4H4zM14 4h6v6h-2V6h-4zM4 14h2v4h4v2H4zM18 14h2v6h-6v-2h4zM9 9h6v6H9z',
  theme: 'M12 3a9 9 0 1 0 0 18 9 9 0 0 0 0-18zm0 2v14a7 7 0 0 1 0-14z',
  panel: 'M4 5h16v14H4zm2 2v10h7V7zm9 0v10h3V7z',
  keys: 'M3 6h18v12H3zm2 2v8h14V8zm1.5 1.5h2v2h-2zm3.5 0h2v2h-2zm3.5 0h2v2h-2zm3.5 0H19v2h-2zM8 13h8v1.8H8z',
};

function icon(name) {
  const svg = document.createElementNS('http://www.w3.org/2000/svg', 'svg');
  svg.setAttribute('viewBox', '0 0 24 24');
  svg.setAttribute('aria-hidden', 'true');
  const path = document.createElementNS('http://www.w3.org/2000/svg', 'path');
  path.setAttribute('d', kIcons[name]);
  path.setAttribute('fill-rule', 'evenodd');
  svg.append(path);
  return svg;
}

function iconButton(name, title, className = 'icon') {
  return make('button', {type: 'button', class: className, title, 'aria-label': title}, icon(name));
}

const counted = (count, noun) => `${count} ${noun}${count === 1 ? '' : 's'}`;
const kSpeeds = [0.1, 0.25, 0.5, 1, 2, 4];
const kKeys = [
  ['Space', 'play or pause'], ['← →', 'one frame back or on; with Shift ten'], ['Home End', 'first or last frame'],
  ['[ ]', 'slower, faster'], ['C', 'contact points'], ['V', 'force lines'], ['J', 'joints'], ['X', 'frames of joints'],
  ['S', 'strain of soft bodies'], ['W', 'their meshes'], ['O', 'the balls on their points'],
  ['M', 'limits of joints'], ['B', 'forces of joints on their second bodies'], ['N', 'names'], ['E', 'stay at the end of a run that goes on'],
  ['F', 'look at the selected body'], ['G', 'follow it'], ['Esc', 'select nothing'], ['R', 'reset the view'],
  ['T', 'light or dark'], ['P', 'panel'], ['Left drag', 'orbit'], ['Right drag', 'pan'], ['Wheel', 'zoom'],
];

export class Interface {
  constructor(recording, actions) {
    this.recording = recording;
    this.actions = actions;
    this.view = make('canvas', {class: 'view', tabindex: 0, 'aria-label': 'Simulation, drag to orbit'});
    this.overlay = make('canvas', {class: 'overlay', 'aria-hidden': 'true'});
    this.note = make('div', {class: 'note', role: 'status'});
    const picture = make('main', {class: 'picture'}, this.view, this.overlay, this.makeTitle(), this.makeToolbar(),
                         this.note, this.makeKeys());
    this.root = make('div', {class: 'avbd'}, picture, this.makePanel(), this.makeTransport());
    this.picture = picture;
    document.body.append(this.root);
  }

  factsText() {
    const {recording} = this;
    const still = recording.types.reduce((sum, type) => sum + (type === 0), 0);
    const moving = recording.solidBodies - still, softs = recording.softs.length;
    const length = recording.times[recording.frameCount - 1] - recording.times[0];
    const facts = [`${moving} moving`, `${still} static`];
    if (softs > 0) facts.push(`${softs} soft`);
    if (recording.joints.length > 0) facts.push(counted(recording.joints.length, 'joint'));
    facts.push(counted(recording.frameCount, 'frame'), `${Number(length.toFixed(2))} s`);
    return facts.join('  ·  ');
  }

  makeTitle() {
    this.titleFacts = make('p', {text: this.factsText()});
    return make('header', {class: 'title'}, make('h1', {text: this.recording.title}), this.titleFacts);
  }

  makeToolbar() {
    this.toggles = {};
    const bar = make('nav', {class: 'toolbar', 'aria-label': 'View'});
    const chip = (name, text, key, there) => {
      const button = make('button', {type: 'button', class: 'chip', 'aria-pressed': 'false', title: `${text} (${key})`},
                          make('i', {class: `dot ${name}`}), make('span', {text}));
      button.disabled = !there;
      button.addEventListener('click', () => this.actions.toggle(name));
      this.toggles[name] = button;
      bar.append(button);
    };
    const touching = this.recording.live || this.recording.contactsAll.some((count) => count > 0);
    if (this.recording.live) chip('tail', 'Live', 'E', true);
    chip('contacts', 'Contacts', 'C', touching);
    chip('forces', 'Forces', 'V', touching);
    chip('joints', 'Joints', 'J', this.recording.joints.length > 0);
    // Of joints there is more to show only where the recording knows more than their anchors.
    if (hasFrames(this.recording)) chip('frames', 'Frames', 'X', true);
    if (hasLimits(this.recording)) chip('limits', 'Limits', 'M', true);
    if (this.recording.jointStates && this.recording.joints.length > 0) chip('reactions', 'Reactions', 'B', true);
    if (this.recording.softs.length > 0) {
      chip('strain', 'Strain', 'S', true);
      chip('wire', 'Mesh', 'W', true);
      chip('balls', 'Points', 'O', true);
    }
    chip('names', 'Names', 'N', this.recording.bodyCount > 0);
    bar.append(make('span', {class: 'gap'}));
    const tool = (name, title, action) => {
      const button = iconButton(name, title);
      button.addEventListener('click', action);
      bar.append(button);
    };
    tool('home', 'Reset the view (R)', () => this.actions.resetView());
    tool('theme', 'Light or dark (T)', () => this.actions.toggle('theme'));
    tool('keys', 'Keys (?)', () => this.toggleKeys());
    tool('panel', 'Panel (P)', () => this.actions.toggle('panel'));
    return bar;
  }

  makeKeys() {
    const rows = kKeys.flatMap(([key, text]) => [make('dt', {text: key}), make('dd', {text})]);
    this.keys = make('div', {class: 'keys', hidden: ''}, make('h2', {text: 'Keys and mouse'}), make('dl', {}, ...rows));
    return this.keys;
  }

  toggleKeys(on = this.keys.hidden) {
    this.keys.hidden = !on;
  }

  makeTransport() {
    this.playButton = iconButton('play', 'Play (space)', 'icon play');
    this.playButton.addEventListener('click', () => this.actions.togglePlay());
    const step = (name, title, count) => {
      const button = iconButton(name, title);
      button.addEventListener('click', () => this.actions.step(count));
      return button;
    };
    this.loopButton = iconButton('loop', 'Start again at the end');
    this.loopButton.addEventListener('click', () => this.actions.toggle('loop'));
    const {times, frameCount} = this.recording;
    this.scrub = make('input', {type: 'range', class: 'scrub', min: times[0], max: times[frameCount - 1], step: 'any',
                                'aria-label': 'Time'});
    this.scrub.value = times[0];
    this.scrub.addEventListener('input', () => this.actions.seek(Number(this.scrub.value)));
    this.clock = make('output', {class: 'clock'});
    this.speed = make('select', {class: 'speed', title: 'Speed ([ and ])', 'aria-label': 'Speed'},
                      ...kSpeeds.map((value) => make('option', {value, text: `${value}×`})));
    this.speed.value = 1;
    this.speed.addEventListener('change', () => this.actions.setSpeed(Number(this.speed.value)));
    const buttons = make('div', {class: 'buttons'}, step('back', 'One frame back (←)', -1), this.playButton,
                         step('forward', 'One frame on (→)', 1), this.loopButton);
    return make('footer', {class: 'transport'}, buttons, this.scrub, this.clock, this.speed);
  }

  nextSpeed(direction) {
    const at = kSpeeds.indexOf(Number(this.speed.value)) + direction;
    this.speed.value = kSpeeds[Math.min(kSpeeds.length - 1, Math.max(0, at))];
    return Number(this.speed.value);
  }

  makePanel() {
    const section = (title, ...content) => make('section', {}, make('h2', {text: title}), ...content);
    this.selection = make('div', {class: 'selection'});
    this.report = section('Report', make('table', {}, make('tbody')));
    this.showReport();
    this.couplings = new CouplingTable(make, this.recording);
    this.softs = new SoftTable(make, this.recording);
    this.panel = make('aside', {class: 'panel', 'aria-label': 'Figures'}, section('Body', this.selection),
                      section('Figures', ...this.makePlots()),
                      this.softs.count > 0 && section('Soft bodies', this.softs.element),
                      this.couplings.count > 0 && section('Couplings and what they miss', this.couplings.element),
                      this.report, this.makeQuality());
    return this.panel;
  }

  /// Of a run that goes on it comes when that has ended.
  showReport() {
    const rows = this.recording.report.map(
        ([label, value]) => make('tr', {}, make('th', {scope: 'row', text: label}), make('td', {text: value})));
    this.report.hidden = rows.length === 0;
    this.report.querySelector('tbody').replaceChildren(...rows);
  }

  makePlots() {
    const {recording} = this;
    const plot = (name, title, unit, color) => this.plots.push(
        new Plot(make, {name, title, unit, color, times: recording.times, values: recording[name], onSeek: this.actions.seek}));
    const {joints} = recording, any = (values) => values.some((value) => value > 0);
    this.plots = [];
    plot('energy', 'Kinetic energy', 'J', '#4e9be6');
    plot('penetration', 'Largest penetration', 'm', '#e8973c');
    if (joints.length > 0 || any(recording.gap)) plot('gap', 'Largest joint gap', 'm', '#e0558c');
    if (any(recording.excess) || joints.some((joint) => limits(joint, [0, 1, 2]))) {
      plot('excess', 'Beyond limits, sliding', 'm', '#9ccc3c');
    }
    if (any(recording.excessAngle) || joints.some((joint) => limits(joint, [3, 4, 5]) || hasCone(joint))) {
      plot('excessAngle', 'Beyond limits, turning', 'rad', '#b58cf0');
    }
    return this.plots.map((item) => item.element);
  }

  makeQuality() {
    const options = [['auto', 'Automatic'], ['0', 'Best'], ['2', 'Middle'], ['3', 'Fast, no shadows']];
    this.quality = make('select', {'aria-label': 'Picture quality'},
                        ...options.map(([value, text]) => make('option', {value, text})));
    this.quality.addEventListener('change', () => this.actions.setQuality(this.quality.value));
    this.rate = make('output', {class: 'rate'});
    return make('section', {class: 'foot'}, make('label', {}, make('span', {text: 'Picture'}), this.quality), this.rate);
  }

  /// A live recording has grown.
  grow() {
    const {times, frameCount} = this.recording;
    this.scrub.min = times[0];
    this.scrub.max = times[frameCount - 1];
    this.titleFacts.textContent = this.factsText();
    for (const plot of this.plots) plot.setData(times, this.recording[plot.name]);
  }

  showSelection(facts) {
    this.selection.replaceChildren();
    if (!facts) {
      this.selection.append(make('p', {class: 'hint', text: 'Click a body to see its name, position and speed.'}));
      this.facts = undefined;
      return;
    }
    const swatch = make('i', {class: 'swatch', style: `background:${facts.color}`});
    const button = (text, action, pressed) => {
      const element = make('button', {type: 'button', class: 'chip small', text, 'aria-pressed': pressed});
      element.addEventListener('click', action);
      return element;
    };
    this.facts = facts.rows.map(() => make('td'));
    const row = (label, i) => make('tr', {}, make('th', {scope: 'row', text: label}), this.facts[i]);
    this.selection.append(
        make('h3', {}, swatch, make('span', {text: facts.name})), make('p', {class: 'hint', text: facts.type}),
        make('table', {}, make('tbody', {}, ...facts.rows.map(row))),
        make('div', {class: 'chips'}, button('Look at', () => this.actions.lookAtSelected()),
             button('Follow', () => this.actions.toggle('follow'), String(facts.follow))));
  }

  /// A text for each of the rows.
  updateSelection(texts) {
    this.facts?.forEach((cell, i) => { cell.textContent = texts[i]; });
  }

  showTime(time, frame) {
    const {times, frameCount} = this.recording;
    this.scrub.value = time;
    const part = (time - times[0]) / (times[frameCount - 1] - times[0] || 1);
    this.scrub.style.setProperty('--done', `${(100 * part).toFixed(2)}%`);
    const digits = String(frameCount - 1).length;
    this.clock.textContent = `${time.toFixed(2)} / ${times[frameCount - 1].toFixed(2)} s   ` +
        `#${String(frame).padStart(digits, '0')}`;
    for (const plot of this.plots) plot.setCursor(time, frame);
  }

  showPlaying(playing) {
    this.playButton.replaceChildren(icon(playing ? 'pause' : 'play'));
    const title = playing ? 'Pause (space)' : 'Play (space)';
    this.playButton.title = title;
    this.playButton.setAttribute('aria-label', title);
  }

  press(name, on) {
    const button = name === 'loop' ? this.loopButton : this.toggles[name];
    button?.setAttribute('aria-pressed', String(on));
  }
}
