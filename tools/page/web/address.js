// A link is a state: what the reader has chosen on the live page, as text after the # of the address, and back. Numbers
// are written so that reading gives the same bits; an angle in degrees where that holds, as for every slider.
//   #theta=89.5deg&phi_dot=-2.9&s=0.03&M_3=1:-6,1.5:0&show=path+force&diagram=path&t=3.2
// `_start` is left out of names; `M_3=1:-6,1.5:0` are changes at 1 s and 1.5 s; `kept.` precedes the plan of the motion
// that is kept beside; `step` is a step of the story. What is not there is as at first.
import {degrees, limitsOf} from '#knobs';

const LONGEST = 4000;  // characters
const MOST = 400;      // changes while it rolls
const NUMBER = /^[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?$/;

export const EMPTY = {
  plan: {values: {}, changes: [], stop: 10},
  kept: null,
  show: {follow: true, path: true, axes: false, force: false},
  diagram: 'phase',
  view: 0,
  t: 0,
};

/** A fault of an address; the message is one sentence for the reader. */
class BadAddress extends Error {}

function numberText(value, unit) {
  const angle = Number((value * 180 / Math.PI).toPrecision(10));
  return unit === 'rad' && degrees(angle) === value ? `${angle}deg` : String(value);
}

function toNumber(text, name) {
  const inDegrees = text.endsWith('deg');
  const digits = inDegrees ? text.slice(0, -3) : text;
  if (!NUMBER.test(digits)) throw new BadAddress(`${name} = ${text.slice(0, 20)} is no number.`);
  return inDegrees ? degrees(Number(digits)) : Number(digits);
}

function within(value, limits, name) {
  if (!limits) throw new BadAddress(`it names ${name.slice(0, 30)}, which cannot be set here.`);
  const [low, high] = limits;
  const slack = 1e-9 * Math.max(Math.abs(low), Math.abs(high));
  if (!(value >= low - slack && value <= high + slack)) {
    const shown = [value, low, high].map((number) => Number(number.toPrecision(4)));
    throw new BadAddress(`${name} = ${shown[0]} is not between ${shown[1]} and ${shown[2]}.`);
  }
  return value;
}

/** A plan {values, changes, stop} as the parts of an address. variables: of the description. */
export function planParts({values, changes, stop}, variables) {
  const parts = {};
  const unit = (name) => variables[name]?.unit;
  for (const [name, value] of Object.entries(values)) {
    if (value !== variables[name]?.start) parts[name.replace(/_start$/, '')] = numberText(value, unit(name));
  }
  for (const name of new Set(changes.map((change) => change.name))) {
    const list = changes.filter((change) => change.name === name);
    const steps = list.map(({t, value}) => `${Number(t.toFixed(4))}:${numberText(value, unit(name))}`);
    parts[name] = [...(name in parts ? [parts[name]] : []), ...steps].join(',');
  }
  if (stop !== EMPTY.plan.stop) parts.stop = String(stop);
  return parts;
}

/** Start value and changes of one variable from `value,t:value,...` into a plan. */
function readValue(plan, name, text) {
  for (const item of text.split(',')) {
    const [t, value] = item.includes(':') ? item.split(':') : [null, item];
    const found = within(toNumber(value, name), limitsOf(name, t !== null), name);
    if (t === null)
      plan.values[name] = found;
    else
      plan.changes.push({t: within(toNumber(t, name), [0, plan.stop], `the time of ${name}`), name, value: found});
  }
}

function readPlan(parts, variables) {
  const plan = {values: {}, changes: [], stop: EMPTY.plan.stop};
  if (parts.has('stop'))
    plan.stop = Math.round(100 * within(toNumber(parts.get('stop'), 'stop'), [1, 60], 'stop')) / 100;
  for (const [part, text] of parts) {
    if (part === 'stop') continue;
    const name = `${part}_start` in variables ? `${part}_start` : part;
    if (!Object.hasOwn(variables, name))
      throw new BadAddress(`it names ${part.slice(0, 30)}, which the wheel has not.`);
    readValue(plan, name, text);
  }
  if (plan.changes.length > MOST) throw new BadAddress(`it holds more than ${MOST} changes.`);
  plan.changes.sort((a, b) => a.t - b.t);
  return plan;
}

const shownText = (show) => Object.keys(show).filter((name) => show[name]).join('+') || 'none';

/** The address of a state without #. base: the state that stands for what is left out; step: 1, 2 ... or null. */
export function write(state, base, step, variables) {
  const parts = step ? {step: String(step)} : planParts(state.plan, variables);
  if (state.kept && !step) {
    const kept = planParts(state.kept, variables);
    parts.kept = 'yes';
    for (const [name, text] of Object.entries(kept)) parts[`kept.${name}`] = text;
  }
  if (shownText(state.show) !== shownText(base.show)) parts.show = shownText(state.show);
  if (state.diagram !== base.diagram) parts.diagram = state.diagram;
  if (state.view !== base.view) parts.view = String(state.view + 1);
  if (state.t.toFixed(2) !== base.t.toFixed(2)) parts.t = String(Number(state.t.toFixed(2)));
  return Object.entries(parts).map(([name, text]) => `${name}=${text}`).join('&');
}

function readShow(text, show) {
  const wanted = text === 'none' ? [] : text.split('+');
  const unknown = wanted.find((name) => !Object.hasOwn(show, name));
  if (unknown !== undefined) throw new BadAddress(`it wants to show ${unknown.slice(0, 30)}, which there is not.`);
  return Object.fromEntries(Object.keys(show).map((name) => [name, wanted.includes(name)]));
}

/** The parts of an address {name: text}; each may stand there once. */
function partsOf(text) {
  if (text.length > LONGEST) throw new BadAddress(`it has more than ${LONGEST} characters.`);
  const parts = new Map();
  for (const part of text.split('&')) {
    const [, name, value] = /^([\w.]+)=([\w.:,+-]+)$/.exec(part) ?? [];
    if (!name) throw new BadAddress(`${part.slice(0, 30)} is no part of an address.`);
    if (parts.has(name)) throw new BadAddress(`${name.slice(0, 30)} stands in it twice.`);
    parts.set(name, value);
  }
  return parts;
}

/** {state, step} of an address without #; throws one sentence. steps: the states of the story. */
export function read(text, steps, diagrams, variables) {
  let plain = text;
  try {
    plain = decodeURIComponent(text);
  } catch {  // a stray % stays as it is, and is refused below
  }
  const parts = partsOf(plain);
  const take = (name) => {
    const value = parts.get(name);
    parts.delete(name);
    return value;
  };
  const step = take('step');
  if (step !== undefined && !steps[step - 1]) throw new BadAddress(`there is no step ${step.slice(0, 20)}.`);
  const state = structuredClone(step ? steps[step - 1] : EMPTY);
  const [show, diagram, view, t, kept] = ['show', 'diagram', 'view', 't', 'kept'].map(take);
  if (show) state.show = readShow(show, state.show);
  if (diagram && !diagrams.includes(diagram)) throw new BadAddress(`there is no diagram ${diagram.slice(0, 20)}.`);
  if (diagram) state.diagram = diagram;
  if (view) state.view = within(toNumber(view, 'view'), [1, 9], 'view') - 1;
  if (t) state.t = within(toNumber(t, 't'), [0, 60], 't');
  const other = new Map([...parts].filter(([name]) => name.startsWith('kept.')).map(([n, v]) => [n.slice(5), v]));
  for (const name of other.keys()) parts.delete(`kept.${name}`);
  if (step && (parts.size || other.size)) throw new BadAddress('a step of the story has no other start.');
  if (step) return {state, step: Number(step)};
  if (kept || other.size) state.kept = readPlan(other, variables);
  state.plan = readPlan(parts, variables);
  return {state, step: null};
}
