// A link is a state: what the reader has chosen on the live page, as text after the # of the address, and back. Numbers
// are written so that reading gives the same bits; an angle in degrees where that holds, as for every slider.
//   #theta=89.5deg&phi_dot=-2.9&s=0.03&M_3=1:-6,1.5:0&show=path+force&diagram=path&t=3.2
// `_start` is left out of names; `M_3=1:-6,1.5:0` are changes at 1 s and 1.5 s; `kept.` precedes the plan of the motion
// that is kept beside; `body` gives the moments of inertia of a preset one; `step` is a step of the story. What is not
// there is as at first.
import {PORTRAITS} from '#curves';
import {DEGREES, degrees, variables} from '#dom';
import {limitsOf} from '#knobs';
import {bodies, MOMENTS, momentsOf} from '#mechanics';

const REST = 400;  // ms between two changes of the address: browsers refuse more than some hundred in half a minute
const NUMBER = /^([-+]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?)(deg)?$/;

export const EMPTY = {
  plan: {values: {}, changes: [], stop: 10, body: null},
  kept: null,
  show: {follow: true, path: true, axes: false, force: false},
  diagram: 'phase',
  view: 0,
  t: 0,
};

/** Ends the reading with one sentence for the reader. */
function refuse(sentence) { throw new Error(sentence); }

function textOf(name, value) {
  if (variables[name]?.type === 'Boolean') return String(Boolean(value));
  const angle = Number((value * DEGREES).toPrecision(10));
  return variables[name]?.unit === 'rad' && degrees(angle) === value ? `${angle}deg` : String(value);
}

/** The number of a text, within limits [lowest, highest]. */
function numberOf(text, name, limits) {
  if (variables[name]?.type === 'Boolean' && /^(true|false)$/.test(text)) return Number(text === 'true');
  const [, digits, unit] = NUMBER.exec(text) ?? refuse(`${name} = ${text.slice(0, 20)} is no number.`);
  const [low, high] = limits ?? refuse(`it names ${name.slice(0, 30)}, which cannot be set here.`);
  const value = unit ? degrees(Number(digits)) : Number(digits);
  const slack = 1e-9 * Math.max(Math.abs(low), Math.abs(high));
  if (value >= low - slack && value <= high + slack) return value;
  const scale = unit ? DEGREES : 1;  // the answer has the unit of the question
  const shown = [value, low, high].map((number) => `${Number((number * scale).toPrecision(4))}${unit ? '°' : ''}`);
  return refuse(`${name} = ${shown[0]} is not between ${shown[1]} and ${shown[2]}.`);
}

/** Gives a plan with a body the moments of its mass and radii. */
export function derive({values, body}) {
  const [m, r_0, r] = ['m', 'r_0', 'r'].map((name) => values[name] ?? variables[name].start);
  if (body) Object.assign(values, momentsOf(body, {m, r_0, r}));
}

/** A plan {values, changes, stop, body} as the parts of an address, whose names begin with `prefix`. */
function planParts({values, changes, stop, body}, prefix = '') {
  const parts = body ? {[`${prefix}body`]: body} : {};
  for (const [name, value] of Object.entries(values))
    if (value !== variables[name]?.start && !(body && MOMENTS.includes(name)))
      parts[prefix + name.replace(/_start$/, '')] = textOf(name, value);
  for (const {t, name, value} of changes) {
    const [part, change] = [prefix + name, `${Number(t.toFixed(4))}:${textOf(name, value)}`];
    parts[part] = part in parts ? `${parts[part]},${change}` : change;
  }
  return stop === EMPTY.plan.stop ? parts : {...parts, [`${prefix}stop`]: stop};
}

const motionParts = ({plan, kept}) => ({...planParts(plan), ...(kept && {kept: 'yes', ...planParts(kept, 'kept.')})});

/** Whether two states show the same motions. */
export const sameMotions = (one, other) => JSON.stringify(motionParts(one)) === JSON.stringify(motionParts(other));

/** A state as the parts of an address. */
function partsOf({show, diagram, view, t, ...motions}) {
  const shown = Object.keys(show).filter((name) => show[name]).join('+') || 'none';
  return {...motionParts(motions), show: shown, diagram, view: view + 1, t: Number(t.toFixed(2))};
}

/** The address of a state without #: how it differs from a step of the story (1, 2 ...), or from EMPTY (null). */
export function write(state, step, steps) {
  const base = partsOf(steps[step - 1] ?? EMPTY);
  const changed = Object.entries(partsOf(state)).filter(([name, text]) => text !== base[name]);
  return [...(step ? [['step', step]] : []), ...changed].map((part) => part.join('=')).join('&');
}

/** A plan from the parts of an address {name: text}: `value`, or `value,t:value,...` with changes while it rolls. */
function planOf({stop: end, body = null, ...parts}) {
  const stop = end ? Math.round(100 * numberOf(end, 'stop', [1, 60])) / 100 : EMPTY.plan.stop;
  const plan = {values: {}, changes: [], stop, body};
  if (body && !Object.hasOwn(bodies, body)) refuse(`there is no body ${body.slice(0, 20)}.`);
  for (const [part, text] of Object.entries(parts)) {
    const name = [`${part}_start`, part].find((other) => Object.hasOwn(variables, other)) ??
        refuse(`it names ${part.slice(0, 30)}, which the wheel has not.`);
    for (const item of text.split(',')) {
      const [value, t] = item.split(':').reverse();
      if (body && MOMENTS.includes(name)) refuse(`${name} follows from m, r_0 and r of the body.`);
      const found = numberOf(value, name, limitsOf(name, t !== undefined));
      if (t === undefined) plan.values[name] = found;
      if (t !== undefined) plan.changes.push({t: numberOf(t, `the time of ${name}`, [0, stop]), name, value: found});
    }
  }
  plan.changes.sort((a, b) => a.t - b.t);
  derive(plan);
  return plan;
}

function readShow(text, show) {
  const wanted = text === 'none' ? [] : text.split('+');
  for (const name of wanted)
    if (!Object.hasOwn(show, name)) refuse(`it wants to show ${name.slice(0, 30)}, which there is not.`);
  return Object.fromEntries(Object.keys(show).map((name) => [name, wanted.includes(name)]));
}

/** The parts of an address {name: text}, and those of the motion beside. */
function split(text) {
  const parts = [...new URLSearchParams(text.replaceAll('+', '%2B'))];
  const {kept = [], own = []} = Object.groupBy(parts, ([name]) => (name.startsWith('kept.') ? 'kept' : 'own'));
  return [own, kept.map(([name, value]) => [name.slice(5), value])].map(Object.fromEntries);
}

/** {state, step} of an address without #; throws one sentence. steps: the states of the story. */
export function read(text, steps = []) {
  const [{step, show, diagram, view, t, kept, ...own}, beside] = split(text);
  const state = structuredClone(step ? steps[step - 1] ?? refuse(`there is no step ${step.slice(0, 20)}.`) : EMPTY);
  if (show) state.show = readShow(show, state.show);
  if (diagram && !Object.hasOwn(PORTRAITS, diagram)) refuse(`there is no diagram ${diagram.slice(0, 20)}.`);
  if (diagram) state.diagram = diagram;
  if (view) state.view = Math.round(numberOf(view, 'view', [1, 9])) - 1;
  if (t) state.t = numberOf(t, 't', [0, 60]);
  const [given, asked] = [own, beside].map((parts) => Object.keys(parts).length);
  if (step && (given || asked)) refuse('a step of the story has no other start.');
  if (step) return {state, step: Number(step)};
  if (kept || asked) state.kept = planOf(beside);
  state.plan = planOf(own);
  return {state, step: null};
}

/** The address of the live page follows what the reader does, and the page follows the address. */
export class Link {
  constructor(live) {
    Object.assign(this, {live, text: null, at: 0, states: live.steps.map(({state}) => state)});
    addEventListener('hashchange', () => location.hash.slice(1) !== this.text && this.follow());
    this.follow();
  }

  /** The address of what is shown, without #. */
  write() { return write(this.live.state(), this.live.narrated ? this.live.step + 1 : null, this.states); }

  /** The whole link. */
  get href() { return `${location.href.split('#')[0]}#${this.write()}`; }

  /** Writes an address; a page inside another may not, and its button still copies the link. */
  put(text, how = 'replaceState') {
    try {
      history[how](null, '', `#${text}`);
      this.text = location.hash.slice(1);  // a browser may ignore changes that come too fast
    } catch {
    }
  }

  /** What is shown now stays a place of the browser's history, and what comes next is another. */
  leave() {
    const text = this.write();
    this.put(text);
    this.put(text, 'pushState');
  }

  /** Shows the state in the address; a wrong one gives the first step of the story and a sentence. */
  follow() {
    this.text = location.hash.slice(1);
    try {
      const {state, step} = read(this.text || 'step=1', this.states);
      this.live.apply(state, step && step - 1);
    } catch (fault) {
      this.live.apply(this.states[0], 0);
      this.live.refusal = `This address cannot be shown: ${fault.message} Here is the first scene instead.`;
    }
  }

  /** Once a frame: writes what has changed. */
  frame() {
    const now = performance.now();
    if (this.live.wanted || now - this.at < REST) return;
    this.at = now;
    const text = this.write();
    // An address that has come and is not followed yet stays, and a wrong one until the reader does something.
    if (text === this.text || this.text !== location.hash.slice(1) || (this.live.refusal && text === 'step=1')) return;
    this.put(text);
  }
}
