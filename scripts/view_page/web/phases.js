// When the rolling friction holds the wheel: stick phases and transitions, read off omega_z and friction_mode.
// A transition lies between two rows; its instant is where omega_z, carried on from the rows on the rolling side, is
// zero.

/** -1 or 1: sign of omega_z while it rolls; 0: omega_z is held at zero. */
function modeAt(table, row) {
  const source = table.columns.friction_mode ?? table.columns.omega_z;
  return Math.sign(source[row]);
}

/** Zero within [low, high] of the parabola through three points, or NaN. */
function zeroOfParabola(t, y, low, high) {
  const slope = (y[1] - y[0]) / (t[1] - t[0]);
  const bend = ((y[2] - y[1]) / (t[2] - t[1]) - slope) / (t[2] - t[0]);
  const b = slope - bend * (t[0] + t[1]);
  const c = y[0] - slope * t[0] + bend * t[0] * t[1];
  const roots = [];
  const q = b * b - 4 * bend * c;
  if (Math.abs(bend) * (high - low) < 1e-9 * Math.abs(b))
    roots.push(-c / b);
  else if (q >= 0)
    roots.push((-b - Math.sqrt(q)) / (2 * bend), (-b + Math.sqrt(q)) / (2 * bend));
  const slack = 0.02 * (high - low);
  const inside = roots.filter((root) => root >= low - slack && root <= high + slack);
  return inside.length ? Math.min(high, Math.max(low, inside[0])) : NaN;
}

/** The instant of the transition between row k and row k + 1. */
function instant(table, k, from) {
  const {time, rows} = table;
  const omega = table.columns.omega_z;
  const middle = 0.5 * (time[k] + time[k + 1]);
  const first = from === 0 ? k + 1 : k - 2;
  if (!omega || first < 0 || first + 2 >= rows) return middle;
  const three = [first, first + 1, first + 2];
  if (three.some((row) => modeAt(table, row) !== modeAt(table, from === 0 ? k + 1 : k))) return middle;
  const t = three.map((row) => time[row] - time[k]);
  const zero = zeroOfParabola(t, three.map((row) => omega[row]), 0, time[k + 1] - time[k]);
  return Number.isNaN(zero) ? middle : time[k] + zero;
}

/** Whether there may be friction: a wheel whose omega_z is zero from first to last may as well roll without any. */
function mayHold(table) {
  if (!table.has('omega_z') && !table.has('friction_mode')) return false;
  return table.time.some((_, row) => modeAt(table, row) !== 0);
}

/**
 * {sticks: [[begin, end], ...], transitions: [{t, from, to}, ...]} in s. friction: whether there is any, where it is
 * known (without it omega_z = 0 holds nothing).
 */
export function phasesOf(table, friction = mayHold(table)) {
  const sticks = [];
  const transitions = [];
  if (!friction) return {sticks, transitions};
  let mode = modeAt(table, 0);
  let begin = table.start;
  for (let k = 0; k + 1 < table.rows; ++k) {
    const next = modeAt(table, k + 1);
    if (next === mode) continue;
    const t = instant(table, k, mode);
    transitions.push({t, from: mode, to: next});
    if (mode === 0) sticks.push([begin, t]);
    [mode, begin] = [next, t];
  }
  if (mode === 0) sticks.push([begin, table.end]);
  return {sticks, transitions};
}

/** Whether the wheel is held at t. */
export function sticksAt(phases, t) { return phases.sticks.some(([begin, end]) => begin <= t && t < end); }
