// Wheels to begin with. values: start values that differ from the defaults of modelDescription.xml; changes: what is
// done while it rolls, [{t [s], name, value}]. Angles in rad.
import {degrees} from '#knobs';

/**
 * |omega_z| above which upright straight rolling is stable, rad/s: a small lean a turns the wheel at
 * omega_2 = (J_z / J_x) omega_z a, and (J_x + m rho^2) a'' = m g r_0 a - (J_z + m rho^2) omega_2 omega_z, rho = r_0 +
 * r.
 */
export function criticalSpin({m, g, r_0, r, J_x, J_z}) {
  return Math.sqrt((m * g * r_0 * J_x) / (J_z * (J_z + m * (r_0 + r) ** 2)));
}

/** Half a degree of lean, and a tenth more spin than the critical (+1) or less (-1). */
export function nearCritical(wheel, side) {
  return {theta_start: degrees(89.5), phi_dot_start: Number((-(1 + 0.1 * side) * criticalSpin(wheel)).toFixed(3))};
}

/** A drive torque from 1 s to 3 s and the brake from 6 s to 7.5 s. */
export const DRIVEN = {
  stop: 10,
  values: {theta_start: degrees(88), phi_dot_start: -4},
  changes: [
    {t: 1, name: 'M_3', value: -4}, {t: 3, name: 'M_3', value: 0}, {t: 6, name: 'M_brake', value: 4},
    {t: 7.5, name: 'M_brake', value: 0}
  ],
};

/** The presets, for the wheel's parameters {m, g, r_0, r, J_x, J_z}. */
export function presets(wheel) {
  const limit = `Upright rolling is stable above ${criticalSpin(wheel).toFixed(2)} rad/s; this wheel is 10 %`;
  return [
    {label: 'Paper, no friction', stop: 10, values: {}},
    {label: 'Paper, s = 0.03 m', stop: 10, values: {s: 0.03}},
    {
      label: 'Just stable',
      stop: 10,
      values: nearCritical(wheel, 1),
      about: `${limit} faster, leans by half a degree and stays up.`,
    },
    {
      label: 'Just unstable',
      stop: 10,
      values: nearCritical(wheel, -1),
      about: `${limit} slower, leans as much and tumbles.`,
    },
    {
      label: 'Thin disc',
      stop: 10,
      values: {r: 0, theta_start: degrees(20), psi_dot_start: 9, phi_dot_start: -9},
      about: 'No tube (r = 0): the rolling disc of the textbooks, low and wobbling like a coin.',
    },
    {
      ...DRIVEN,
      label: 'Driven',
      about: 'A motor pushes with M₃ = −4 N m from 1 s to 3 s, and the brake acts with 4 N m from 6 s to 7.5 s.',
    },
  ];
}
