// A link is a state: what the reader has chosen on the live page, as text after the # of the address, and back. Numbers
// are written so that reading gives the same bits; an angle in degrees where that holds, as for every slider.
//   #theta=89.5deg&phi_dot=-2.9&s=0.03&M_3=1:-6,1.5:0&show=path+force&diagram=path&t=3.2
// `_start` is left out of names; `M_3=1:-6,1.5:0` are changes at 1 s and 1.5 s; `kept.` precedes the plan of the motion
// that is kept beside; `step` is a step of the story. What is not there is as at first.
import {degrees, limitsOf} from '#knobs';

const LONGEST = 4000;  // characters
const MOST = 400;      // changes while it rolls
const NUMBER = /^([-+]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?)(deg)?$/;

export const EMPTY = {
  plan: {values: {}, changes: [], stop: 10},
  kept: null,
  show: {follow: true, path: true, axes: false, force: false},
  diagram: 'phase',
  view: 0,
  t: 0,
};

/** Ends the reading with one sentence for the reader. */
function refuse(sentence) { throw new Error(sentence); }

function numberText(value, unit) {
  const angle = Number((value * 180 / Math.PI).toPrecision(10));
  return unit === 'rad' && degrees(angle) === value ? `${angle}deg` : String(value);
}

/** The number of a text, within limits [lowest, highest]. */
function numberOf(text, name, limits) {
  const [, digits, unit] = NUMBER.exec(text) ?? refuse(`${name} = ${text.slice(0, 20)} is no number.`);
  const [low, high] = limits ?? refuse(`it names ${name.slice(0, 30)}, which cannot be set here.`);
  const value = unit ? degrees(Number(digits)) : Number(digits);
  const slack = 1e-9 * Math.max(Math.abs(low), Math.abs(high));
  if (value >= low - slack && value <= high + slack) return value;
  const shown = [value, low, high].map((number) => Number(number.toPrecision(4)));
  return refuse(`${name} = ${shown[0]} is not between ${shown[1]} and ${shown[2]}.`);
}

/** A plan {values, changes, stop} as the parts of an address. variables: of the description. */
export function planParts({values, changes, stop}, variables) {
  const parts = {};
  const textOf = (name, value) => numberText(value, variables[name]?.unit);
  for (const [name, value] of Object.entries(values))
    if (value !== variables[name]?.start) parts[name.replace(/_start$/, '')] = textOf(name, value);
  for (const {t, name, value} of changes) {
    const change = `${Number(t.toFixed(4))}:${textOf(name, value)}`;
    parts[name] = name in parts ? `${parts[name]},${change}` : change;
  }
  if (stop !== EMPTY.plan.stop) parts.stop = String(stop);
  return parts;
}

/** A plan from the parts of an address {name: text}: `value`, or `value,t:value,...` with changes while it rolls. */
function planOf({stop: end, ...parts}, variables) {
  const stop = end ? Math.round(100 * numberOf(end, 'stop', [1, 60])) / 100 : EMPTY.plan.stop;
  const plan = {values: {}, changes: [], stop};
  for (const [part, text] of Object.entries(parts)) {
    const name = [`${part}_start`, part].find((other) => Object.hasOwn(variables, other)) ??
        refuse(`it names ${part.slice(0, 30)}, which the wheel has not.`);
    for (const item of text.split(',')) {
      const [value, t] = item.split(':').reverse();
      const found = numberOf(value, name, limitsOf(name, t !== undefined));
      if (t === undefined)
        plan.values[name] = found;
      else
        plan.changes.push({t: numberOf(t, `the time of ${name}`, [0, stop]), name, value: found});
    }
  }
  if (plan.changes.length > MOST) refuse(`it holds more than ${MOST} changes.`);
  plan.changes.sort((a, b) => a.t - b.t);
  return plan;
}

const shownText = (show) => Object.keys(show).filter((name) => show[name]).join('+') || 'none';

/** The address of a state without #. base: the state that stands for what is left out; step: 1, 2 ... or null. */
export function write(state, base, step, variables) {
  const parts = step ? {step} : planParts(state.plan, variables);
  if (state.kept && !step) {
    parts.kept = 'yes';
    for (const [name, text] of Object.entries(planParts(state.kept, variables))) parts[`kept.${name}`] = text;
  }
  if (shownText(state.show) !== shownText(base.show)) parts.show = shownText(state.show);
  if (state.diagram !== base.diagram) parts.diagram = state.diagram;
  if (state.view !== base.view) parts.view = state.view + 1;
  if (state.t.toFixed(2) !== base.t.toFixed(2)) parts.t = Number(state.t.toFixed(2));
  return Object.entries(parts).map(([name, text]) => `${name}=${text}`).join('&');
}

function readShow(text, show) {
  const wanted = text === 'none' ? [] : text.split('+');
  const unknown = wanted.find((name) => !Object.hasOwn(show, name));
  if (unknown !== undefined) refuse(`it wants to show ${unknown.slice(0, 30)}, which there is not.`);
  return Object.fromEntries(Object.keys(show).map((name) => [name, wanted.includes(name)]));
}

/** The parts of an address [[name, text], ...]; each may stand there once. */
function partsOf(text) {
  if (text.length > LONGEST) refuse(`it has more than ${LONGEST} characters.`);
  let plain = text;
  try {
    plain = decodeURIComponent(text);
  } catch {  // a stray % stays as it is, and is refused below
  }
  const parts = new Map();
  for (const part of plain.split('&')) {
    const [, name, value] =
        /^([\w.]+)=([\w.:,+-]+)$/.exec(part) ?? refuse(`${part.slice(0, 30)} is no part of an address.`);
    if (parts.has(name)) refuse(`${name.slice(0, 30)} stands in it twice.`);
    parts.set(name, value);
  }
  return parts;
}

/** {state, step} of an address without #; throws one sentence. steps: the states of the story. */
export function read(text, steps, diagrams, variables) {
  const {step, show, diagram, view, t, kept, ...parts} = Object.fromEntries(partsOf(text));
  const state = structuredClone(step ? steps[step - 1] ?? refuse(`there is no step ${step.slice(0, 20)}.`) : EMPTY);
  if (show) state.show = readShow(show, state.show);
  if (diagram && !diagrams.includes(diagram)) refuse(`there is no diagram ${diagram.slice(0, 20)}.`);
  if (diagram) state.diagram = diagram;
  if (view) state.view = Math.round(numberOf(view, 'view', [1, 9])) - 1;
  if (t) state.t = numberOf(t, 't', [0, 60]);
  if (step && Object.keys(parts).length) refuse('a step of the story has no other start.');
  if (step) return {state, step: Number(step)};
  const isKept = ([name]) => name.startsWith('kept.');
  const own = Object.fromEntries(Object.entries(parts).filter((part) => !isKept(part)));
  const other = Object.fromEntries(Object.entries(parts).filter(isKept).map(([name, value]) => [name.slice(5), value]));
  if (kept || Object.keys(other).length) state.kept = planOf(other, variables);
  state.plan = planOf(own, variables);
  return {state, step: null};
}
