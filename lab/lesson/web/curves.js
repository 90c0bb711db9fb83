// What the diagrams show, by name: curves over time, and planes: the tilt's rate over the tilt, and the path of the
// contact point from above. The friction circle and the bars of an upright wheel have classes of their own
// (diagrams.js).
import {DEGREES} from '#dom';
import {criticalSpin, resistance} from '#pictures';
import {contactOf, extent} from '#table';

const LEANING = 10 / DEGREES;  // rad, up to which the critical spin of upright rolling is a measure
const UPRIGHT = Math.PI / 2;
const HOLD = ['tau', 'omega_z_dot', 'theta', 'lambda_3', 's', 'M_brake'];

/**
 * A curve over time: the columns it needs, and its values from theirs and the wheel, of which the second is dashed.
 * band: the second is the limit of a band about zero; second: its colour beside one wheel's own; whole: the axis while
 * the future is a secret.
 */
const curve = (title, unit, digits, columns, what, values, more) => ({
  form: 'time',
  title,
  unit,
  digits,
  columns,
  what: `${what} over time. Click or drag to go there`,
  values,
  ...more
});

/** A point [x, y] over another quantity; even: both axes have one scale. */
const plane = (title, units, columns, what, point, more) =>
    ({form: 'plane', title, unit: '', units, columns, what, point, ...more});

const guided = ({parameters}) => Boolean(parameters.guided);
/** Whether a wheel is upright until its first slide ends. */
const upright = ({table: {columns: {time, theta}}, phases: {slides}}) =>
    time.every((t, i) => t > slides[0][1] || Math.abs(theta[i] - UPRIGHT) < 1e-3);
/** Whether the speed of the centre and that of rolling are the subject: of a wheel in its plane. */
const brakes = (wheel) => guided(wheel) || (wheel.phases.slides.length > 0 && upright(wheel));
const moves = ({table}, name) => {
  const [low, high] = extent(table.shown[name] ?? []);
  return high - low > 1e-6 * Math.max(Math.abs(low), Math.abs(high));
};

export const KINDS = {
  lean: curve(
      'lean 90° − θ', '°', 1, ['theta'], 'Lean: angle of the wheel to the vertical, 90° where it lies flat,',
      ([theta]) => [90 - DEGREES * theta], {fits: (wheel) => moves(wheel, 'theta'), whole: [0, 90]}),
  spin: curve(
      'spin −ω_z', 'rad/s', 3, ['omega_z'], 'Spin: angular velocity about the axle, positive where it rolls forward,',
      ([omega]) => [-omega], {
        fits: (wheel) => !brakes(wheel),
        level: ({parameters, table}) => {
          const known = parameters.J_x === parameters.J_y && !parameters.guided;
          return known && Math.abs(table.columns.theta[0] - UPRIGHT) < LEANING ? criticalSpin(parameters) : NaN;
        },
      }),
  speeds: curve(
      'v, dashed −R ω_z', 'm/s', 2, ['X_O_dot', 'Y_O_dot', 'psi', 'theta', 'psi_dot', 'omega_z'],
      'Speed of the centre along e1, and dashed that of rolling, which is −R ω_z for an upright wheel, R = r_0 + r,',
      ([X_dot, Y_dot, psi, theta, psi_dot, omega_z], {parameters: {r_0, r}}) =>
          [X_dot * Math.cos(psi) + Y_dot * Math.sin(psi),
           r * Math.cos(theta) * psi_dot * Math.sin(theta) - (r_0 + r * Math.sin(theta)) * omega_z],
      {fits: brakes, second: '--turn'}),
  load: curve(
      'wheel load N', 'N', 0, ['lambda_3'], 'Wheel load', ([N]) => [N], {fits: (wheel) => moves(wheel, 'lambda_3')}),
  carrier: curve(
      'M_guide,1, dashed M_guide,2', 'N m', 1, ['M_guide_1', 'M_guide_2'],
      'Moment of the wheel carrier on the wheel along e1, and dashed along e2,', (both) => both,
      {fits: (wheel) => moves(wheel, 'M_guide_1') || moves(wheel, 'M_guide_2')}),
  energy: curve('energy E', 'J', 2, ['E'], 'Total energy', ([E]) => [E]),
  hold: curve(
      'moment that would hold the spin', 'N m', 1, HOLD,
      'Moment about the axle that would hold the spin, and as a band what rolling resistance has, from −s N to s N,',
      (values, {parameters}) => {
        const {hold, most} = resistance(parameters, (name) => values[HOLD.indexOf(name)]);
        return [hold, most];
      },
      {band: true}),
  path: plane(
      'path from above', ['m', 'm'], ['X_O', 'Y_O', 'psi', 'theta'],
      'Path of the contact point on the road, from above', (values, {parameters: {r_0}}) => contactOf(r_0, ...values),
      {even: true}),
  phase: plane(
      'rate of θ in °/s over θ', ['°', '°/s'], ['theta', 'theta_dot'],
      'Phase portrait: the rate of θ over θ. Without rolling resistance one closed curve',
      (values) => values.map((value) => value * DEGREES)),
  circle: {
    form: 'circle',
    title: 'friction circle',
    unit: 'N',
    columns: ['lambda_x', 'lambda_y', 'lambda_3', 'slip_x', 'slip_y'],
    what: 'Friction circle: the force of the road along it, forward up, within the most that grip and sliding have',
  },
  bars: {
    form: 'bars',
    title: 'moments per radian of lean',
    unit: 'N m',
    columns: [],
    what: 'Moments per radian of lean of the wheel that rolls upright: one that tips it, and one that rights it',
  },
};

/** The diagrams of recorded wheels that have something to show. */
export const RECORDED = ['lean', 'spin', 'speeds', 'load', 'carrier', 'energy', 'path'];

/** Whether a kind has something to show of a wheel. */
export const fits = (kind, wheel) =>
    kind.columns.every((name) => wheel.table.has(name)) && (kind.fits?.(wheel) ?? true);
