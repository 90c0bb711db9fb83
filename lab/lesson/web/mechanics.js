// The wheel's mechanics as far as the page itself computes it: moments of inertia of the bodies (examples/bodies.json),
// which follow from mass and radii; the critical spin; the moments about e1. SI.
import {live} from '#dom';

/** bodies {name: {title, source, J_x, J_z}}: the moments over m, as parts of the squares of lengths. */
export const {bodies = {}, POINTS} = live ?? {};
export const MOMENTS = ['J_x', 'J_y', 'J_z'];

/** {J_x, J_y, J_z} of a body. */
export function momentsOf(name, {m, r_0, r}) {
  const lengths = {r_0, r, R: r_0 + r};
  const term = ([length, part]) => {
    const [above, below = 1] = part.split('/');
    return above / below * (lengths[length] * lengths[length]);
  };
  const [J_x, J_z] = ['J_x', 'J_z'].map(
      (moment) => m * Object.entries(bodies[name][moment]).map(term).reduce((sum, value) => sum + value, 0));
  return {J_x, J_y: J_x, J_z};
}

/**
 * |omega_z| above which upright straight rolling is stable, rad/s: a small lean a turns the wheel at
 * omega_2 = (J_z / J_x) omega_z a, and (J_x + m rho^2) a'' = m g r_0 a - (J_z + m rho^2) omega_2 omega_z, rho = r_0 +
 * r.
 */
export function criticalSpin({m, g, r_0, r, J_x, J_z}) {
  return Math.sqrt((m * g * r_0 * J_x) / (J_z * (J_z + m * (r_0 + r) ** 2)));
}

/** The rate at which a fast upright wheel nutates over its spin omega_z. */
export function nutation({m, r_0, r, J_x, J_y, J_z}) {
  const [J, R2] = [Math.min(J_x, J_y), (r_0 + r) ** 2];
  return Math.sqrt(J_z * (J_z + m * R2) / (J * (J + m * R2)));
}

/**
 * The moments about e1 through the centre of a wheel with J_x = J_y that nothing but weight and ground acts on, N m:
 * of the normal force, which carries the weight r_0 cos theta beside the centre; of the ground's force across e1, at
 * the height of the centre; and the gyroscopic one. They add up to J_x theta_ddot. at(name): a variable at one instant.
 */
export function balance({r_0, r, J_x, J_z}, at) {
  const [psi, theta, psi_dot, omega_z, lambda_1, lambda_2, N] =
      ['psi', 'theta', 'psi_dot', 'omega_z', 'lambda_1', 'lambda_2', 'lambda_3'].map(at);
  const lambda_y = lambda_2 * Math.cos(psi) - lambda_1 * Math.sin(psi);
  return {
    weight: -N * r_0 * Math.cos(theta),
    side: lambda_y * (r_0 * Math.sin(theta) + r),
    gyro: -(J_z * omega_z - J_x * psi_dot * Math.cos(theta)) * psi_dot * Math.sin(theta),
    sum: J_x * at('theta_ddot'),
  };
}
