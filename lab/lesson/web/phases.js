// When friction or a brake holds the wheel, and when it slides, true to half a row of the record: read off
// friction_mode (or omega_z), the slip, and n_events, the wheel's own count of transitions.

/** Whether the wheel slides in a row: its slip is exactly zero while it rolls. */
function slidesAt({columns: {slip_x: along, slip_y: across}}, row) { return Boolean(along?.[row] || across?.[row]); }

/** [[begin, end], ...] in s of the rows of which `holds` is true. */
function spansOf(table, holds) {
  const {time, end} = table;
  const turnAt = (t, k) => {
    const turns = holds(table, k) !== (k > 0 && holds(table, k - 1));
    return turns ? [k ? 0.5 * (time[k - 1] + t) : t] : [];
  };
  const turns = Array.from(time, turnAt).flat();
  return turns.flatMap((t, i) => (i % 2 ? [] : [[t, turns[i + 1] ?? end]]));
}

/** -1 or 1: sign of omega_z while it rolls; 0: omega_z is held at zero. */
function modeAt({columns: {friction_mode, omega_z}}, row) { return Math.sign((friction_mode ?? omega_z)[row]); }

/**
 * How many transitions of the friction lie between rows k and k + 1: as the wheel counts them less the loss or return
 * of grip, else one where the mode changes.
 */
function countBetween(table, k) {
  const {n_events: count} = table.columns;
  if (!count) return Number(modeAt(table, k) !== modeAt(table, k + 1));
  return count[k + 1] - count[k] - Number(slidesAt(table, k) !== slidesAt(table, k + 1));
}

/** Whether there may be friction: a wheel whose omega_z is zero from first to last may as well roll without any. */
function mayHold(table) {
  const count = table.columns.n_events;
  if (!table.has('omega_z') && !table.has('friction_mode')) return false;
  if (count) return count.at(-1) > count[0];
  return table.time.some((_, row) => modeAt(table, row) !== 0);
}

/**
 * {sticks: [[begin, end], ...], slides: likewise, transitions: [t, ...]} in s; several transitions between two rows
 * stand evenly. friction: whether there is any, where it is known (without it omega_z = 0 holds nothing).
 */
export function phasesOf(table, friction = mayHold(table)) {
  const slides = spansOf(table, slidesAt);
  if (!friction) return {sticks: [], slides, transitions: []};
  const {time} = table;
  const transitions = Array.from({length: table.rows - 1}, (_, k) => {
    const n = Math.max(0, countBetween(table, k));
    return Array.from({length: n}, (_, i) => time[k] + (time[k + 1] - time[k]) * (i + 1) / (n + 1));
  });
  return {sticks: spansOf(table, (table, row) => modeAt(table, row) === 0), slides, transitions: transitions.flat()};
}
