// Pulleys, couplings and custom joints: the lines that show of them, and what the panel says of them.
import {typeOf} from './joints.js';
import {placed} from './motion.js';
import {kWorld} from './recording.js';
import {Dots, Segments} from './segments.js';
import {withUnit} from './plots.js';

const kNamed = ['pulley', 'coupling', 'custom'];
const kCoordinates = ['x', 'y', 'z', 'twist', 'swing y', 'swing z'];
const kPowers = ['', '²', '³', '⁴'];
const kMostRows = 40;

export const isCoupling = (joint) => kNamed.includes(typeOf(joint));
/// Joints without anchors: their frames say nothing.
export const isBodiless = (joint) => typeOf(joint) === 'coupling';

const short = (value) => Number(value.toPrecision(4));

/// The name that the model gives, or what tells a joint from others of its type.
function nameOf(recording, i) {
  const joint = recording.joints[i];
  if (!joint) return 'a joint';
  if (joint.name) return joint.name;
  const bodies = [joint.a, joint.b].filter(({body}) => body !== kWorld).map(({body}) => recording.nameOf(body));
  return bodies.join('–') || `joint ${i}`;
}

/// One summand of L: "2 wheel.twist²".
function termText(recording, {joint, axis, factors}) {
  const variable = `${nameOf(recording, joint)}.${kCoordinates[axis]}`;
  const times = (factor) => (Math.abs(factor) === 1 ? (factor < 0 ? '-' : '') : `${short(factor)} `);
  return factors.map((factor, i) => (factor === 0 ? '' : `${times(factor)}${variable}${kPowers[i]}`)).filter(Boolean).join(' + ');
}

/// What the joint is about, in a line.
export function describe(recording, i) {
  const joint = recording.joints[i];
  if (typeOf(joint) === 'custom') return joint.family || 'custom';
  if (typeOf(joint) === 'pulley') return joint.ratio === 1 ? 'pulley' : `pulley, a + ${short(joint.ratio)} b`;
  const sum = joint.terms.map((term) => termText(recording, term)).filter(Boolean).join(' + ').replaceAll('+ -', '− ');
  return joint.free ? `${sum} = L` : `${sum} = ${short(joint.rest)}`;
}

/// The rows of the panel: a name, what the joint is about, and an element for its residual.
export class CouplingTable {
  constructor(make, recording) {
    this.recording = recording;
    const all = recording.joints.map((_, i) => i).filter((i) => isCoupling(recording.joints[i]));
    this.rows = all.slice(0, kMostRows).map((i) => {
      const value = make('td'), name = recording.joints[i].name, text = describe(recording, i);
      const label = make('th', {scope: 'row', text: name || text, title: name ? text : undefined});
      return {i, value, element: make('tr', {}, label, value)};
    });
    const more = all.length - this.rows.length;
    this.element = make('div', {class: 'couplings'}, make('table', {}, make('tbody', {}, ...this.rows.map(({element}) => element))),
                        more > 0 && make('p', {class: 'hint', text: `and ${more} more`}));
    this.count = all.length;
  }

  /// `residuals` of all joints at the frame; none where they are not known.
  show(residuals, off) {
    for (const {i, value} of this.rows) {
      const joint = this.recording.joints[i];
      const own = residuals.slice(joint.firstResidual, joint.firstResidual + joint.residuals);
      // Of the others each number has a unit of its own.
      const shown = (number) => (typeOf(joint) === 'pulley' || !Number.isFinite(number) ? withUnit(number, 'm') : short(number));
      const text = off(i) ? 'off' : Array.from(own, shown).join('  ') || '–';
      if (value.textContent !== text) value.textContent = text;
    }
  }
}

/// Ropes over their wheels, and lines between what is coupled.
export class CouplingMarks {
  constructor(recording) {
    this.recording = recording;
    this.ropes = new Segments(0xf4d58d, 3, 9);
    this.wheels = new Dots(0xf4d58d, 11, 12);
    this.lines = new Segments(0x8fe3a1, 1.5, 8);
    this.all = [this.ropes, this.wheels, this.lines];
  }

  /// Where an end of a joint is in the world.
  pointOf({body, anchor}, poses) {
    return body === kWorld ? anchor : placed(poses, body, anchor, [0, 0, 0]);
  }

  update(shown, poses, off) {
    const lists = {ropes: [], wheels: [], lines: []};
    this.recording.joints.forEach((joint, i) => {
      if (!shown || !isCoupling(joint) || off(i)) return;
      if (typeOf(joint) === 'pulley') this.addRope(lists, joint, poses);
      else strip(this.pointsOf(joint, poses), lists.lines);
    });
    this.ropes.set(Float32Array.from(lists.ropes), lists.ropes.length / 6);
    this.wheels.set(Float32Array.from(lists.wheels), lists.wheels.length / 3);
    this.lines.set(Float32Array.from(lists.lines), lists.lines.length / 6);
  }

  addRope(lists, joint, poses) {
    const [wheelA, wheelB] = joint.wheels;
    if (![...wheelA, ...wheelB].every(Number.isFinite)) return;
    strip([this.pointOf(joint.a, poses), wheelA, wheelB, this.pointOf(joint.b, poses)], lists.ropes);
    lists.wheels.push(...wheelA, ...wheelB);
  }

  /// Of a coupling the places of its joints, of a custom joint the bodies that it acts on.
  pointsOf(joint, poses) {
    const {joints} = this.recording;
    if (typeOf(joint) === 'coupling') {
      return joint.terms.map((term) => joints[term.joint]).filter((other) => other && !isBodiless(other))
          .map((other) => this.pointOf(other.a.body === kWorld && other.b.body !== kWorld ? other.b : other.a, poses));
    }
    return [joint.a.body, joint.b.body, ...joint.more].filter((body) => body !== kWorld)
        .map((body) => Array.from(poses.subarray(7 * body, 7 * body + 3)));
  }
}

function strip(points, out) {
  for (let i = 0; i + 1 < points.length; ++i) out.push(...points[i], ...points[i + 1]);
}
