// When the rolling friction holds the wheel, and when it slides: stick phases and transitions, read off friction_mode
// (or the sign of omega_z) and n_events, the wheel's own count of transitions. A transition lies between two rows; its
// instant is where omega_z, carried on from the rows on a rolling side, is zero.

/** -1 or 1: sign of omega_z while it rolls; 0: omega_z is held at zero. */
function modeAt(table, row) {
  const source = table.columns.friction_mode ?? table.columns.omega_z;
  return Math.sign(source[row]);
}

/** The zeros of the parabola through three points (t, y); NaN where there is none. */
function zerosOfParabola(t, y) {
  const slope = (y[1] - y[0]) / (t[1] - t[0]);
  const bend = ((y[2] - y[1]) / (t[2] - t[1]) - slope) / (t[2] - t[0]);
  const b = slope - bend * (t[0] + t[1]);
  const c = y[0] - slope * t[0] + bend * t[0] * t[1];
  const q = -0.5 * (b + (b < 0 ? -1 : 1) * Math.sqrt(b * b - 4 * bend * c));  // no difference of equal numbers
  return [c / q, q / bend];
}

/**
 * Where omega_z, carried on through rows first to first + 2, is zero between rows k and k + 1; undefined if nowhere.
 */
function zeroBetween(table, k, first) {
  const {time, rows, columns: {omega_z: omega}} = table;
  const three = [first, first + 1, first + 2];
  if (!omega || first < 0 || first + 2 >= rows) return undefined;
  const [mode, ...modes] = three.map((row) => modeAt(table, row));
  if (mode === 0 || modes.some((other) => other !== mode)) return undefined;
  const step = time[k + 1] - time[k];
  const zeros = zerosOfParabola(three.map((row) => time[row] - time[k]), three.map((row) => omega[row]));
  const zero = zeros.find((t) => t >= -0.02 * step && t <= 1.02 * step);
  return zero === undefined ? zero : time[k] + Math.min(step, Math.max(0, zero));
}

/**
 * How many transitions of the friction lie between rows k and k + 1: as the wheel counts them less the loss or return
 * of grip, else one where the mode changes.
 */
function countBetween(table, k) {
  const {n_events: count} = table.columns;
  if (!count) return Number(modeAt(table, k) !== modeAt(table, k + 1));
  return count[k + 1] - count[k] - Number(slidesAt(table, k) !== slidesAt(table, k + 1));
}

/** Whether the wheel slides: its slip is exactly zero while it rolls. */
function slidesAt({columns: {slip_x: along, slip_y: across}}, row) { return Boolean(along?.[row] || across?.[row]); }

/** [[begin, end], ...] in s in which it slides, true to half a row. */
function slidesOf(table) {
  const {time, end} = table;
  const turnAt = (t, k) =>
      (slidesAt(table, k) === (k > 0 && slidesAt(table, k - 1)) ? [] : [k ? 0.5 * (time[k - 1] + t) : t]);
  const turns = Array.from(time, turnAt).flat();
  return turns.flatMap((t, i) => (i % 2 ? [] : [[t, turns[i + 1] ?? end]]));
}

/**
 * The instants of the n transitions between rows k and k + 1: the first and the last from the rolling rows on their
 * side, where there are such, the others evenly between them.
 */
function instants(table, k, n) {
  const [low, high] = [table.time[k], table.time[k + 1]];
  const [before, after] = [zeroBetween(table, k, k - 2), zeroBetween(table, k, k + 1)];
  if (n === 1) return [before ?? after ?? 0.5 * (low + high)];
  const even = (high - low) / (n + 1);
  let [first, last] = [before ?? low + even, after ?? high - even];
  if (first > last) [first, last] = [low + even, high - even];
  return Array.from({length: n}, (_, i) => first + ((last - first) * i) / (n - 1));
}

/**
 * Whether the wheel is held after i of the n transitions that lead from one mode to the next: the modes between are not
 * recorded, so stick and slip take turns.
 */
function heldAfter(i, n, from, to) {
  if (i === 0) return from === 0;
  const held = (n - i) % 2 === (to === 0 ? 0 : 1);
  return held && !(i === 1 && from === 0);
}

/** Whether there may be friction: a wheel whose omega_z is zero from first to last may as well roll without any. */
function mayHold(table) {
  const count = table.columns.n_events;
  if (count) return count.at(-1) > count[0];
  if (!table.has('omega_z') && !table.has('friction_mode')) return false;
  return table.time.some((_, row) => modeAt(table, row) !== 0);
}

/**
 * {sticks: [[begin, end], ...], slides: likewise, transitions: [t, ...]} in s. friction: whether there is any, where it
 * is known (without it omega_z = 0 holds nothing).
 */
export function phasesOf(table, friction = mayHold(table)) {
  const sticks = [];
  const transitions = [];
  const slides = slidesOf(table);
  if (!friction) return {sticks, slides, transitions};
  let begin = table.start;
  for (let k = 0; k + 1 < table.rows; ++k) {
    const [from, to] = [modeAt(table, k), modeAt(table, k + 1)];
    const n = countBetween(table, k);
    if (n === 0 && from !== to) begin = table.time[k + 1];  // there was no friction yet
    for (const [i, t] of (n > 0 ? instants(table, k, n) : []).entries()) {
      transitions.push(t);
      if (heldAfter(i, n, from, to)) sticks.push([begin, t]);
      begin = t;
    }
  }
  if (modeAt(table, table.rows - 1) === 0) sticks.push([begin, table.end]);
  return {sticks, slides, transitions};
}
