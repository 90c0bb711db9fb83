// The wheels' names over their views, with what each does at the present: rolls, is held, or why its motion has ended.
import {sticksAt} from '#phases';

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
  if (N && N.at(-1) < LIFTED * N.reduce((most, value) => Math.max(most, value), 0)) return `lifted off at ${when}`;
  return table.end < latest - 1e-9 ? `its record ends at ${when}` : null;
}

export class Labels {
  constructor(host) { this.host = host; }

  /** rectangles: {x, y, w, h} of each view in CSS pixels; wheels: those of each view. */
  layOut(rectangles, wheels) {
    this.host.replaceChildren();
    rectangles.forEach(({x, y, w, h}, v) => {
      const edge = document.createElement('div');
      edge.className = 'edge';
      Object.assign(edge.style, {left: `${x}px`, top: `${y}px`, width: `${w}px`, height: `${h}px`});
      const names = document.createElement('div');
      names.className = 'names';
      edge.append(names);
      for (const wheel of wheels[v]) {
        wheel.tag = document.createElement('div');
        wheel.tag.className = 'label card';
        wheel.tag.innerHTML = `<i style="background:${wheel.colour}"></i><b></b><span></span>`;
        wheel.tag.querySelector('b').textContent = wheel.label;
        names.append(wheel.tag);
      }
      this.host.append(edge);
    });
  }

  /** What each wheel does at t, in a few words. */
  tell(wheels, t) {
    for (const {tag, ended, table, phases} of wheels) {
      const over = ended && t >= table.end;
      const sticks = sticksAt(phases, t);
      const state = over ? 'ended' : sticks ? 'sticks' : 'rolls';
      if (tag.dataset.state === state && !over) continue;
      tag.dataset.state = state;
      tag.lastChild.innerHTML = sticks && !over ? 'held: ω<sub>z</sub> = 0' : '';
      if (over) tag.lastChild.textContent = short(ended);
    }
  }
}
