// What the reader of the live page can set: sliders with numbers beside them, buttons, and within which limits a number
// or an address may set the rest. The sliders' ranges follow the wheel.
import {DEGREES, variables} from '#dom';
import {criticalSpin} from '#mechanics';

const ROUND = [1, 1.2, 1.5, 2, 2.5, 3, 4, 5, 6, 7, 8, 10];

/** The next round number at or above a positive one. */
function roundUp(value) {
  const power = 10 ** Math.floor(Math.log10(value));
  return Number((power * ROUND.find((digit) => digit * power >= value * (1 - 1e-9))).toPrecision(6));
}

/** Some 200 round steps to a side. */
function stepOf(high) {
  const power = 10 ** Math.floor(Math.log10(high / 200));
  return Number((power * [5, 2, 1].find((digit) => digit * power <= high / 200)).toPrecision(6));
}

const upTo = (high) => [0, high, stepOf(high)];
const both = (high) => [-high, high, stepOf(high)];
/** m g (r_0 + r) in N m, over the paper's wheel's. */
const weight = (value) => value('m') * value('g') * (value('r_0') + value('r'));
const strength = (wheel) => weight((name) => wheel[name]) / weight((name) => variables[name].start);
const spins = (wheel) => both(roundUp(4.5 * criticalSpin(wheel)));
const inertias = (low, high) =>
    ({m, r_0, r}) => [...[low, high].map((part) => Number((part * m * (r_0 + r) ** 2).toPrecision(2))), 'log'];

/**
 * A quantity: its name, symbol, unit and meaning as shown (angles in degrees), and the slider's range(wheel): lowest,
 * highest, step ('log': by ratios).
 */
const knob = (name, symbol, unit, what, range) => ({name, symbol, unit, what, range});

export const START = [
  knob('theta_start', 'θ', '°', 'tilt', () => [5, 175, 0.5]),
  knob('phi_dot_start', 'φ̇', 'rad/s', 'rotation', spins),
  knob('psi_dot_start', 'ψ̇', 'rad/s', 'precession', spins),
  knob('slope', 'α', '°', 'slope', () => [0, 30, 0.5]),
  knob('slope_direction', 'β', '°', 'uphill', () => [-180, 180, 1]),
];
/** Of the road, and how the wheel is thrown onto it. */
export const GRIP = [
  knob('mu_max', 'μ_max', '', 'static', () => upTo(2)),
  knob('mu_slide', 'μ_slide', '', 'kinetic', () => upTo(2)),
  knob('slip_x_start', 'u_x', 'm/s', 'along', () => both(10)),
  knob('slip_y_start', 'u_y', 'm/s', 'across', () => both(10)),
];
export const WHEEL = [
  knob('m', 'm', 'kg', 'mass', () => [1e-3, 1e3, 'log']),
  knob('r_0', 'r_0', 'm', 'ring radius', () => [0.005, 2, 'log']),
  knob('r', 'r', 'm', 'tube radius', ({r_0}) => upTo(r_0)),
  knob('J_x', 'J_x', 'kg m²', '= J_y', inertias(0.02, 1)),
  knob('J_z', 'J_z', 'kg m²', 'axle', inertias(0.04, 1.2)),
];
/** These act from the present on; those of the wheel carrier on a guided wheel alone. */
export const NOW = [
  knob('s', 's', 'm', 'resistance', ({r_0, r}) => upTo(roundUp(0.28 * (r_0 + r)))),
  knob('M_3', 'M₃', 'N m', 'torque', (wheel) => both(roundUp(8 * strength(wheel)))),
  knob('M_brake', 'M_b', 'N m', 'brake', (wheel) => upTo(roundUp(8 * strength(wheel)))),
  knob('psi_dot_guide', 'ψ̇', 'rad/s', 'steering', () => both(1)),
  knob('theta_dot_guide', 'θ̇', 'rad/s', 'leaning', () => both(1)),
];
export const STEERING = ['psi_dot_guide', 'theta_dot_guide'];
/** Buttons that act as long as they are held: text, variable, value in parts of the torque from the spin, tooltip. */
export const HELD = [
  ['◀ push back', 'M_3', (spin) => -(spin || -1), 'Torque about the axle against the rolling direction'],
  ['brake', 'M_brake', () => 1, 'A dry brake that holds, up to its torque'],
  ['push forward ▶', 'M_3', (spin) => spin || -1, 'Torque about the axle in the rolling direction'],
];
/** Their torque, N m: 6 N m for the paper's wheel, for others as their weight times radius. */
export const torqueOf = (wheel) => Number((6 * strength(wheel)).toPrecision(6));

/** What has no slider and can be set by an address. */
const OTHERS = ['g', 'J_y', 'psi_start', 'phi_start', 'X_O_start', 'Y_O_start', 'guided'];
/** Up to which a number is taken, by unit, so that no run keeps the page waiting. */
const LARGEST = {
  'kg': 1e4,
  'm': 100,
  'kg.m2': 1e6,
  'rad': 2 * Math.PI,
  'rad/s': 1000,
  'm/s': 100,
  'm/s2': 100,
  'N.m': 1e5,
  '1': 10,
};

/**
 * [lowest, highest] in SI of a start value, or (now) of what can change while it rolls, as far as the description has
 * them; undefined for all else.
 */
export function limitsOf(name, now = false) {
  const known = now ? NOW : [...START, ...GRIP, ...WHEEL, ...NOW];
  if (!known.some((one) => one.name === name) && (now || !OTHERS.includes(name))) return undefined;
  const {type, unit, low, high} = variables[name];
  if (type === 'Boolean') return [0, 1];
  return [low === '' ? -LARGEST[unit] : Number(low), Math.min(high === '' ? Infinity : Number(high), LARGEST[unit])];
}

/** The limits of a quantity in the unit that is shown. */
export function shownLimits({name, unit}) {
  return limitsOf(name).map((value) => (unit === '°' ? Number((value * DEGREES).toPrecision(12)) : value));
}
