// What the diagrams show: curves over time, of which a scene has those that belong to it, and portraits: the phase
// portrait, the angular velocity along e2 and e3, or the path of the contact point from above.
import {DEGREES} from '#dom';
import {criticalSpin} from '#mechanics';
import {contactOf, extent} from '#table';

const POSE = ['X_O', 'Y_O', 'psi', 'theta'];

/** A kind of diagram: the columns it needs, and its point [x, y] from their values and the wheel. */
const kind = (symbol, units, columns, what, point, more) => ({symbol, units, columns, what, point, ...more});
const curve = (symbol, unit, digits, columns, what, values, more) => kind(
    symbol, ['s', unit], ['time', ...columns], `${what} over time. Click or drag to go there`,
    ([t, ...all], wheel) => [t, ...values(all, wheel)], {digits, ...more});
const guided = ({parameters}) => Boolean(parameters.guided);
/** Whether a wheel is upright until its first slide ends. */
const upright = ({table: {columns: {time, theta}}, phases: {slides}}) =>
    time.every((t, i) => t > slides[0][1] || Math.abs(theta[i] - Math.PI / 2) < 1e-3);
/** Whether the speed of the centre and that of rolling are the subject: of a wheel in its plane. */
const brakes = (wheel) => guided(wheel) || (wheel.phases.slides.length > 0 && upright(wheel));
const acts = ({table: {shown}}) => ['M_guide_1', 'M_guide_2'].some(
    (name) => shown[name]?.some((moment) => Math.abs(moment) > 1e-9));
const moves = (wheels, name) => wheels.some(({table}) => {
  const [low, high] = extent(table.shown[name]);
  return high - low > 1e-6 * Math.max(Math.abs(low), Math.abs(high));
});
/**
 * fits(wheels): whether a curve belongs to these. A second value is dashed.
 */
export const CURVES = [
  curve(
      'θ', '°', 1, ['theta'], 'Tilt: angle between axle and vertical; the lean is 90° − θ',
      ([theta]) => [DEGREES * theta], {fits: (wheels) => !wheels.some(brakes) || moves(wheels, 'theta')}),
  curve('ω_z', 'rad/s', 3, ['omega_z'], 'Angular velocity about the axle', ([omega]) => [omega], {
    fits: (wheels) => !wheels.some(brakes),
    level: (wheel) => (wheel.J_x === wheel.J_y && !wheel.guided ? criticalSpin(wheel) : NaN)
  }),
  curve(
      'v, ┄ −R ω_z', 'm/s', 2, ['X_O_dot', 'Y_O_dot', 'psi', 'theta', 'psi_dot', 'omega_z'],
      'Speed of the centre along e1, and dashed that of rolling, which is −R ω_z for an upright wheel, R = r_0 + r,',
      ([X_dot, Y_dot, psi, theta, psi_dot, omega_z], {parameters: {r_0, r}}) =>
          [X_dot * Math.cos(psi) + Y_dot * Math.sin(psi),
           r * Math.cos(theta) * psi_dot * Math.sin(theta) - (r_0 + r * Math.sin(theta)) * omega_z],
      {fits: (wheels) => wheels.some(brakes)}),
  curve(
      'N', 'N', 0, ['lambda_3'], 'Wheel load', ([N]) => [N],
      {fits: (wheels) => !wheels.some(brakes) || moves(wheels, 'lambda_3')}),
  curve(
      'M_guide e_1, ┄ e_2', 'N m', 1, ['M_guide_1', 'M_guide_2'],
      'Moment of the wheel carrier on the wheel along e1, and dashed along e2,', (both) => both,
      {fits: (wheels) => wheels.some((wheel) => guided(wheel) && acts(wheel))}),
  curve('E', 'J', 2, ['E'], 'Total energy', ([E]) => [E]),
];
/** even: both axes have one scale. */
export const PORTRAITS = {
  phase: kind(
      'θ̇ (θ)', ['°', '°/s'], ['theta', 'theta_dot'],
      'Phase portrait: the rate of the tilt over the tilt. Without friction one closed curve',
      (values) => values.map((value) => value * DEGREES),
      {fits: (wheels) => !wheels.every(guided) || moves(wheels, 'theta')}),
  spin: kind(
      'ω_z (ω_2)', ['rad/s', 'rad/s'], ['theta', 'psi_dot', 'omega_z'],
      'Angular velocity about the axle over that about e2, which points up in the plane of the wheel. ' +
          'Without friction one curve, run to and fro',
      ([theta, psi_dot, omega_z]) => [psi_dot * Math.sin(theta), omega_z]),
  path: kind(
      'path', ['m', 'm'], POSE, 'Path of the contact point on the ground, from above',
      (values, {parameters: {r_0}}) => contactOf(r_0, ...values), {even: true}),
};
