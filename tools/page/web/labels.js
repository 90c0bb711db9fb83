// The wheels' names over their views, with what each does at the present: rolls, is held, or why its motion has ended.
import {make, subscripted} from '#dom';
import {extent} from '#table';

const FLAT = 1e-4;    // rad from lying flat
const LIFTED = 1e-3;  // of the largest normal force

/** A sentence with at most five significant digits in each of its numbers. */
export function short(text) {
  return text.replace(/\d+\.\d+(e[-+]?\d+)?/g, (number) => String(Number(Number(number).toPrecision(5))));
}

/** Why a recorded motion ended, read off its last row, or null; `latest`: the end of the longest of all, s. */
export function endingOf(table, latest) {
  const last = (name) => table.columns[name].at(-1);
  const when = `${short(String(table.end.toFixed(4)))} s`;
  if (Math.min(last('theta'), Math.PI - last('theta')) < FLAT) return `fell flat at ${when}`;
  const N = table.columns.lambda_3;
  if (N && N.at(-1) < LIFTED * extent(N)[1]) return `lifted off at ${when}`;
  return table.end < latest - 1e-9 ? `its record ends at ${when}` : null;
}

/** host: lies over the scene. rectangles: {x, y, w, h} of each view in CSS pixels; wheels: those of each view. */
export function layOutLabels(host, rectangles, wheels) {
  host.replaceChildren(...rectangles.map(({x, y, w, h}, v) => {
    const names = make('div', {className: 'names'});
    for (const wheel of wheels[v]) {
      const dot = make('i', {style: `background:${wheel.colour}`});
      wheel.tag = make('div', {className: 'label card'}, dot, make('b', {}, wheel.label), make('span'));
      names.append(wheel.tag);
    }
    return make('div', {className: 'edge', style: `left:${x}px;top:${y}px;width:${w}px;height:${h}px`}, names);
  }));
}

/** What a wheel does at t: [state, in a few words]. */
export function stateOf({ended, table, phases}, t) {
  if (ended && t >= table.end) return ['ended', short(ended)];
  return phases.sticks.some(([begin, end]) => begin <= t && t < end) ? ['sticks', 'held: ω_z = 0'] : ['rolls', ''];
}

/** Writes beside each wheel's name what it does at t. */
export function showStates(wheels, t) {
  for (const wheel of wheels) {
    const [state, text] = stateOf(wheel, t);
    if (wheel.tag.title === text && wheel.tag.dataset.state) continue;
    Object.assign(wheel.tag, {title: text}).dataset.state = state;
    wheel.tag.lastChild.replaceChildren(...(state === 'sticks' ? subscripted(text) : [text]));
  }
}
