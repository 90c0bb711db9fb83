// The wheels' names over their views, with what each does at the present: rolls, is held, or why its motion has ended.
import {make, subscripted} from '#dom';
import {KINDS} from '#pictures';
import {extent, slipOf} from '#table';

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
  if (Math.min(last('theta'), Math.PI - last('theta')) < FLAT) return `lies flat at ${when}`;
  if (table.jams) return `jams at ${when}`;
  const N = table.columns.lambda_3;
  if (N && N.at(-1) < LIFTED * extent(N)[1]) return `lifted off at ${when}`;
  return table.end < latest - 1e-9 ? `its record ends at ${when}` : null;
}

/** host: lies over the scene and gets an element for each view, laid out by style.css; views: the wheels of each. */
export function layOutLabels(host, views) {
  for (const wheel of views.flat()) {
    const dot = make('i', {style: `background:${wheel.colour}`});
    wheel.tag = make('div', {className: 'label card'}, dot, make('b', {}, wheel.label), make('span'));
  }
  host.replaceChildren(...views.map((wheels) => make('div', {className: 'view'}, ...wheels.map(({tag}) => tag))));
}

const MARKS = [['sticks', '--stick', 'held: ω_z = 0'], ['slides', '--slide', 'slides']];

/** Below the scene: how long an arrow as long as the radius is, by kind, and the marks of path and time that occur. */
export function showLegend(host, wheels, units) {
  const arrows = Object.entries(units).map(([kind, {number, colours}]) => {
    const names =
        Object.entries(colours).map(([name, own]) => make('b', {style: `color:var(${own})`}, ...subscripted(name)));
    return make('span', {}, ...names.flatMap((name, i) => [i ? ', ' : '', name]), ` ${number} ${KINDS[kind]}`);
  });
  const key = arrows.length ? [make('span', {}, 'An arrow as long as the radius:'), ...arrows] : [];
  const found = MARKS.filter(([name]) => wheels.some(({phases}) => phases[name].length));
  host.replaceChildren(
      ...key,
      ...found.map(
          ([, name, text]) => make('span', {}, make('i', {style: `background:var(${name})`}), ...subscripted(text))));
}

/** Writes beside each wheel's name how it moves at t. */
export function showStates(wheels, t) {
  for (const {tag, ended, table, phases} of wheels) {
    const over = ended && t >= table.end;
    const [held, slides] =
        [phases.sticks, phases.slides].map((all) => all.some(([begin, end]) => begin <= t && t < end));
    const [state, title] = over ? ['ended', short(ended)] :
        slides ? ['slides', `slides at ${slipOf(table, t).toFixed(2)} m/s${held ? ', held: ω_z = 0' : ''}`] :
        held ? ['sticks', 'held: ω_z = 0'] :
               ['rolls', ''];
    if (tag.title === title && tag.dataset.state) continue;
    Object.assign(tag, {title}).dataset.state = state;
    tag.lastChild.replaceChildren(...(held ? subscripted(title) : [title]));
  }
}
