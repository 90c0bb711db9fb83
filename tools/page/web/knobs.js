// What the reader of the live page can set: sliders, buttons, and within which limits an address may set the rest.
const DEGREES = 180 / Math.PI;

/** An angle in rad as a slider gives it. */
export const degrees = (angle) => angle / DEGREES;

/**
 * Sliders: name, symbol, unit, lowest, highest and step as shown (angles in degrees; 'log': by ratios), and what it is.
 */
export const START = [
  ['theta_start', 'θ', '°', 5, 175, 0.5, 'tilt'],
  ['phi_dot_start', 'φ̇', 'rad/s', -12, 12, 0.05, 'spin'],
  ['psi_dot_start', 'ψ̇', 'rad/s', -12, 12, 0.05, 'precession'],
  ['slope', 'α', '°', 0, 30, 0.5, 'slope'],
  ['slope_direction', 'β', '°', -180, 180, 1, 'uphill'],
  ['mu_max', 'μ', '', 0, 2, 0.01, 'grip, 0: any'],
];
export const WHEEL = [
  ['m', 'm', 'kg', 0.001, 1000, 'log', 'mass'],
  ['r_0', 'r_0', 'm', 0.005, 2, 'log', 'ring radius'],
  ['r', 'r', 'm', 0, 0.5, 0.0005, 'tube radius'],
  ['J_x', 'J_x', 'kg m²', 1e-8, 1000, 'log', '= J_y'],
  ['J_z', 'J_z', 'kg m²', 1e-8, 1000, 'log', 'axle'],
];
/** These act from the present on. */
export const NOW = [
  ['s', 's', 'm', 0, 0.1, 0.0005, 'friction'],
  ['M_3', 'M₃', 'N m', -8, 8, 0.1, 'axle torque'],
  ['M_brake', 'M_b', 'N m', 0, 8, 0.1, 'brake'],
];
/** Buttons that act as long as they are held: text, variable, value in parts of the torque from the spin, tooltip. */
export const HELD = [
  ['◀ push back', 'M_3', (spin) => -(spin || -1), 'Push against the way it rolls, about the axle'],
  ['brake', 'M_brake', () => 1, 'A dry brake that holds, up to its torque'],
  ['push forward ▶', 'M_3', (spin) => spin || -1, 'Push on the way it rolls, about the axle'],
];
/** Their torque, N m: 6 N m for the paper's wheel, for others as their weight times radius. */
export const torqueOf = ({m, g, r_0, r}) =>
    Math.min(8, Number((6 * m * g * (r_0 + r) / (20 * 9.81 * 0.35)).toPrecision(6)));

/** Lowest and highest, in SI, of what has no slider. */
const OTHERS = new Map([['g', [0.5, 30]], ['J_y', [1e-8, 1000]], ['psi_start', [-10, 10]], ['phi_start', [-10, 10]]]);

/** [lowest, highest] in SI of what may be set at the start, or (now) while it rolls; undefined for all else. */
export function limitsOf(name, now = false) {
  const knob = (now ? NOW : [...START, ...WHEEL, ...NOW]).find(([other]) => other === name);
  if (!knob) return now ? undefined : OTHERS.get(name);
  return [knob[3], knob[4]].map((value) => (knob[2] === '°' ? degrees(value) : value));
}
