// One motion as columns over time (SI, fixed axes X, Y, Z, Z up), and its values between the rows.
// Angles are never wrapped, so between two rows they are interpolated as numbers, not as attitudes: a slerp would take
// the shorter turn, and a fast wheel would seem to run backwards.

/** Bytes of a base64 text. */
export const bytesOf = (text) => Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));

/** The smallest and the largest of some values, NaN aside, or [Infinity, -Infinity]. */
export function extent(values) {
  const both = ([low, high], value) => [value < low ? value : low, value > high ? value : high];
  return values.reduce(both, [Infinity, -Infinity]);
}

/** The next number at or above a positive one that is 1, 2 or 5 times a power of ten. */
export function roundUp(value) {
  const power = 10 ** Math.floor(Math.log10(value));
  return Number((power * [1, 2, 5, 10].find((digit) => digit * power >= value * (1 - 1e-9))).toPrecision(6));
}

/** The index of the last of rising instants at or before t, or -1. */
export function before(times, t) {
  let [low, high] = [-1, times.length];
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    [low, high] = times[middle] <= t ? [middle, high] : [low, middle];
  }
  return low;
}

export const POSE = ['X_O', 'Y_O', 'Z_O', 'psi', 'theta', 'phi'];
const POLE = 10;  // the last step of a normal force that grows without bound: many times the force before

export class Table {
  /**
   * columns: {name: Float64Array}, all of one length, `time` rising. shown: the same, but where the sliding wheel jams
   * its force, which grows without bound, is no number.
   */
  constructor(columns) {
    this.columns = columns;
    this.time = columns.time;
    this.rows = this.time.length;
    const {lambda_3: N, slip_x, slip_y} = columns;
    const slides = Boolean(slip_x?.at(-1) || slip_y?.at(-1));
    this.jams = slides && N !== undefined && !(Math.abs(N.at(-1)) <= POLE * Math.abs(N.at(-2)));
    const forces = Object.entries(columns).filter(([name]) => this.jams && name.startsWith('lambda_'));
    const known = ([name, values]) => [name, values.map((value, row) => (row < this.rows - 1 ? value : NaN))];
    this.shown = {...columns, ...Object.fromEntries(forces.map(known))};
  }

  /** From base64 of little-endian doubles, as the page carries them. */
  static decode(texts) {
    const columns = Object.entries(texts).map(([name, text]) => [name, new Float64Array(bytesOf(text).buffer)]);
    return new Table(Object.fromEntries(columns));
  }

  has(name) { return name in this.columns; }

  get start() { return this.time[0]; }

  get end() { return this.time[this.rows - 1]; }

  /** The row at or before t, at most the last but one. */
  row(t) { return Math.max(0, Math.min(before(this.time, t), this.rows - 2)); }

  /**
   * A column at t: of the pose the cubic through both rows' values and rates, if those are known; else a line.
   */
  value(name, t) {
    const values = this.shown[name];
    const i = this.row(t);
    const h = this.time[i + 1] - this.time[i];
    const x = h > 0 ? Math.min(1, Math.max(0, (t - this.time[i]) / h)) : 1;
    const [a, b] = [values[i], values[i + 1]];
    const rates = POSE.includes(name) && this.columns[`${name}_dot`];
    if (!rates) return a + x * (b - a);
    const y = 1 - x;
    return a * y * y * (1 + 2 * x) + b * x * x * (3 - 2 * x) + h * x * y * (y * rates[i] - x * rates[i + 1]);
  }
}

/** Contact with the ground, O - (r_0 + r sin theta) e2 - r cos theta e3, seen from above; r drops out. */
export function contactOf(r_0, X_O, Y_O, psi, theta) {
  const across = r_0 * Math.cos(theta);
  return [X_O + across * Math.sin(psi), Y_O - across * Math.cos(psi)];
}

/** Speed of the slip in m/s; 0 where none is recorded. */
export const slipOf = (table, t) =>
    Math.hypot(...['slip_x', 'slip_y'].map((name) => (table.has(name) ? table.value(name, t) : 0)));

const FINEST = 64;  // points of the path between two rows, at most
const TURN = 0.06;  // rad, of the heading from point to point

/**
 * The contact point's path {times, points}: every row, and between two rows as many points as the wheel turns, along
 * whose heading e1 it runs, but for r theta_dot across.
 */
export function traceOf(table, r_0) {
  const {time, rows, columns: {psi}} = table;
  const times = [];
  for (let i = 0; i + 1 < rows; ++i) {
    const count = Math.min(FINEST, Math.max(1, Math.ceil(Math.abs(psi[i + 1] - psi[i]) / TURN)));
    for (let k = 0; k < count; ++k) times.push(time[i] + (k / count) * (time[i + 1] - time[i]));
  }
  times.push(table.end);
  const pose = (t) => ['X_O', 'Y_O', 'psi', 'theta'].map((name) => table.value(name, t));
  return {times, points: times.map((t) => contactOf(r_0, ...pose(t)))};
}
