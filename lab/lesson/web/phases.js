// When the rolling resistance holds the wheel, and when it slides: stick phases and transitions, read off friction_mode
// (or the sign of omega_z) and n_events, the wheel's own count of transitions.

/** -1 or 1: sign of omega_z while it rolls; 0: omega_z is held at zero. */
function modeAt(table, row) {
  const source = table.columns.friction_mode ?? table.columns.omega_z;
  return Math.sign(source[row]);
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
 * The instants of the n transitions between rows k and k + 1: the first and the last where omega_z, carried on in a
 * line from two rolling rows on their side, is zero, if there is such a zero; the others evenly between them.
 */
function instants(table, k, n) {
  const {time, columns: {omega_z}} = table;
  const [low, high, even] = [time[k], time[k + 1], (time[k + 1] - time[k]) / (n + 1)];
  const zeroOf = (a, b, otherwise) => {
    const t = time[a] - omega_z?.[a] * (time[b] - time[a]) / (omega_z?.[b] - omega_z?.[a]);
    const near = modeAt(table, a) === modeAt(table, b) && t > low - even && t < high + even;
    return near ? Math.min(high, Math.max(low, t)) : otherwise;
  };
  const end = zeroOf(k + 1, k + 2, high - even);
  const begin = zeroOf(k - 1, k, n === 1 ? end : low + even);
  const [first, last] = begin > end ? [low + even, high - even] : [begin, end];
  return Array.from({length: n}, (_, i) => first + (last - first) * (i / (n - 1) || 0));
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
