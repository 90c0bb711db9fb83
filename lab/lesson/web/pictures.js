// What a student cannot see and the FMU has: momentum and moment of precession, the wheel load that rolling
// resistance moves forward, the velocities at the contact, the force of the ground and the moment of a wheel carrier.
// Each is a number read off the outputs of the FMU, and an arrow of the scene. SI; carrier axes e1, e2, e3, or forward
// (along e1), left and up.
import {extent, roundUp} from '#table';

export const GHOST = 0.3;             // s: how far ahead the turned axle is drawn
const [USUAL, LONGEST] = [1.3, 4.5];  // radii of the wheel: an arrow of the mean square, and the longest
const SAMPLES = 200;                  // of a motion, for the scale of its arrows
const SMALL = 1e-4;                   // of a start, from upright rolling
const UPRIGHT = Math.PI / 2;

/** Units of the kinds of arrows; a length is drawn as it is. */
export const KINDS = {
  momentum: 'kg m²/s',
  moment: 'N m',
  force: 'N',
  speed: 'm/s',
};

/** rho = r_0 + r sin theta and eta = r cos theta: the contact is at -rho e2 - eta e3 from the centre. */
const arms = ({r_0, r}, theta) => [r_0 + r * Math.sin(theta), r * Math.cos(theta)];

/**
 * About the contact, where the road has no moment: the angular momentum L along e3, and the moment M of the weight
 * along e1. L omega_2 is the part of M that turns the axle; the rest tilts it.
 */
export function precession(wheel, at) {
  const {m, g, r_0, J_z} = wheel;
  const [theta, psi_dot, omega_z] = ['theta', 'psi_dot', 'omega_z'].map(at);
  const [rho, eta] = arms(wheel, theta);
  const L = (J_z + m * rho ** 2) * omega_z - m * rho * eta * psi_dot * Math.sin(theta);
  return {L, M: -m * g * r_0 * Math.cos(theta)};
}

/**
 * The moment about the axle that would hold omega_z as it is, and the most that rolling resistance and brake have; for
 * J_x = J_y. The inertia about the axle is that of a wheel whose turn (omega_2) is free.
 */
export function resistance(wheel, at) {
  const {m, J_x, J_z, guided} = wheel;
  const [rho, eta] = arms(wheel, at('theta'));
  const coupled = guided ? 0 : (m * rho * eta) ** 2 / (J_x + m * eta ** 2);
  const inertia = J_z + m * rho ** 2 - coupled;
  const most = at('s') * at('lambda_3') + at('M_brake');
  return {hold: at('tau') - inertia * at('omega_z_dot'), most};
}

/** Velocities at the contact, forward and left: of the centre, of the turn about it, and their sum, the slip. */
export function contact(_wheel, at) {
  const [v, slip] = [['v_x', 'v_y'], ['slip_x', 'slip_y']].map((names) => names.map(at));
  return {v, turn: slip.map((part, i) => part - v[i]), slip};
}

/**
 * |omega_z| above which upright straight rolling is stable, rad/s: a small lean a turns the wheel at
 * omega_2 = (J_z / J_x) omega_z a, and (J_x + m R^2) a'' = m g r_0 a - (J_z + m R^2) omega_2 omega_z, R = r_0 + r.
 */
export function criticalSpin({m, g, r_0, r, J_x, J_z}) {
  return Math.sqrt((m * g * r_0 * J_x) / (J_z * (J_z + m * (r_0 + r) ** 2)));
}

/**
 * N m per radian of lean of the wheel that rolls upright: {tips, rights}, from the accelerations that the FMU has for
 * starts beside it, values being the run's own. A lean a turns the wheel at omega_2 = -(d psi_ddot / d theta_dot) a.
 */
export function perRadian(fmu, values) {
  const beside = (more) => {
    const rest = {s: 0, mu_max: 0, mu_slide: 0, slip_x_start: 0, theta_start: UPRIGHT, psi_dot_start: 0};
    return fmu.accelerations({...values, ...rest, theta_dot_start: 0, ...more});
  };
  const mobility = beside({M_1: SMALL}).theta_ddot / SMALL;  // 1 over the moment of inertia about the line of contact
  const lean = beside({theta_start: UPRIGHT - SMALL}).theta_ddot / SMALL;
  const turn = beside({psi_dot_start: SMALL}).theta_ddot / SMALL;
  const tilt = beside({theta_dot_start: SMALL}).psi_ddot / SMALL;
  return {tips: -lean / mobility, rights: -turn * tilt / mobility};
}

/**
 * The arrows of a picture: needs: columns of the motion; fits(parameters); arrows(parameters, at): [{name, kind, place:
 * 'centre', vector along e1, e2, e3, or 'contact', forward, left, up; from: where it begins, m; after: the vector at
 * whose tip it begins; color}].
 */
const picture = (needs, arrows, fits = () => true) => ({needs, arrows, fits});

const PICTURES = {
  precession: picture(
      ['psi_dot', 'omega_z'],
      (wheel, at) => {
        const {L, M} = precession(wheel, at);
        const own = {kind: 'momentum', place: 'centre'};
        return [
          {...own, name: 'L', vector: [0, 0, L], color: '--momentum'},
          {...own, name: 'ghost', vector: [M * GHOST, 0, L], color: '--momentum', faint: true},
          {...own, name: 'dL', vector: [M * GHOST, 0, 0], after: [0, 0, L], color: '--tips'},
          {name: 'M', kind: 'moment', place: 'centre', vector: [M, 0, 0], color: '--tips'},
        ];
      },
      ({J_x, J_y, guided}) => J_x === J_y && !guided),
  resistance: picture(
      ['tau', 'lambda_3'],
      (wheel, at) => {
        const [N, tau] = [at('lambda_3'), at('tau') - at('tau_brake')];
        const from = [N > 0 ? tau / N : 0, 0, 0];
        const own = {place: 'contact', color: '--force'};
        return [
          {...own, name: 'N', kind: 'force', vector: [0, 0, N], from},
          {...own, name: 's', kind: 'length', vector: from, from: [0, -0.5 * wheel.r_0, 0.02 * wheel.r_0]},
        ];
      }),
  sliding: picture(
      ['v_x', 'v_y', 'slip_x', 'slip_y'],
      (wheel, at) => {
        const {v, turn, slip} = contact(wheel, at);
        const beside = (part) => [0, part * (wheel.r_0 + wheel.r), 0.02 * wheel.r_0];
        const own = {kind: 'speed', place: 'contact'};
        return [
          {...own, name: 'v', vector: [...v, 0], from: beside(-0.4), color: '--v'},
          {...own, name: 'R ω_z', vector: [...turn, 0], after: [...v, 0], from: beside(-0.65), color: '--turn'},
          {...own, name: 'slip', vector: [...slip, 0], from: beside(-0.9), color: '--slide'},
        ];
      }),
  slip: picture(['slip_x', 'slip_y'], (wheel, at) => [{
                                        name: 'slip',
                                        kind: 'speed',
                                        place: 'contact',
                                        vector: [at('slip_x'), at('slip_y'), 0],
                                        from: [0, 0, 0.03 * wheel.r_0],
                                        color: '--slide'
                                      }]),
  force: picture(
      ['lambda_1', 'lambda_2', 'lambda_3'],
      (_wheel, at) => {
        const [psi, X, Y, N] = ['psi', 'lambda_1', 'lambda_2', 'lambda_3'].map(at);
        const [c, s] = [Math.cos(psi), Math.sin(psi)];
        const vector = [X * c + Y * s, Y * c - X * s, N];
        return [{name: 'F', kind: 'force', place: 'contact', vector, color: '--force'}];
      }),
  carrier: picture(
      ['M_guide_1', 'M_guide_2'],
      (_wheel, at) => {
        const vector = [at('M_guide_1'), at('M_guide_2'), 0];
        return [{name: 'M_guide', kind: 'moment', place: 'centre', vector, color: '--guide'}];
      }),
};

/** The arrows of some pictures for a wheel {table, parameters} at t, of which it has all quantities. */
export function arrowsOf({table, parameters}, names, t) {
  const known = names.map((name) => PICTURES[name])
                    .filter(({needs, fits}) => needs.every((name) => table.has(name)) && fits(parameters));
  return known.flatMap(({arrows}) => arrows(parameters, (name) => (table.has(name) ? table.value(name, t) : 0)));
}

/**
 * {kind: {number: what an arrow as long as the radius stands for, colours: {name: of the arrow}}}: one for all wheels
 * and their whole motion.
 */
export function unitsOf(wheels, names) {
  const found = {};
  for (const wheel of wheels) {
    const {start, end} = wheel.table;
    for (let i = 0; i <= SAMPLES; ++i) {
      for (const {kind, name, vector, color, faint} of arrowsOf(wheel, names, start + i / SAMPLES * (end - start))) {
        const size = Math.hypot(...vector);
        if (!(kind in KINDS) || size <= 1e-12) continue;
        const {sizes, colours} = (found[kind] ??= {sizes: [], colours: {}});
        sizes.push(size);
        if (!faint) colours[name] = color;
      }
    }
  }
  const unit = ([kind, {sizes, colours}]) => {
    const square = sizes.reduce((sum, size) => sum + size ** 2, 0) / sizes.length;
    return [kind, {number: roundUp(Math.max(Math.sqrt(square) / USUAL, extent(sizes)[1] / LONGEST)), colours}];
  };
  return Object.fromEntries(Object.entries(found).map(unit));
}

/** The rate at which a fast upright wheel nutates over its spin omega_z. */
export function nutation({m, r_0, r, J_x, J_y, J_z}) {
  const [J, R2] = [Math.min(J_x, J_y), (r_0 + r) ** 2];
  return Math.sqrt(J_z * (J_z + m * R2) / (J * (J + m * R2)));
}
