// Wheels to begin with. values: start values that differ from the defaults of modelDescription.xml; changes: what is
// done while it rolls, [{t [s], name, value}]. Angles in rad.
const DEGREE = Math.PI / 180;

/**
 * |omega_z| above which upright straight rolling is stable, rad/s: a small lean a turns the wheel at
 * omega_2 = (J_z / J_x) omega_z a, and (J_x + m rho^2) a'' = m g r_0 a - (J_z + m rho^2) omega_2 omega_z, rho = r_0 +
 * r.
 */
export function criticalSpin({m, g, r_0, r, J_x, J_z}) {
  return Math.sqrt((m * g * r_0 * J_x) / (J_z * (J_z + m * (r_0 + r) ** 2)));
}

/** The presets, for the wheel's parameters {m, g, r_0, r, J_x, J_z}. */
export function presets(wheel) {
  const limit = criticalSpin(wheel);
  const upright = {theta_start: 89.5 * DEGREE};
  return [
    {label: 'Paper, no friction', stop: 10, values: {}},
    {label: 'Paper, s = 0.03 m', stop: 10, values: {s: 0.03}},
    {
      label: 'Just stable',
      stop: 10,
      values: {...upright, phi_dot_start: -1.1 * limit},
      about: `Upright rolling is stable above ${
          limit.toFixed(2)} rad/s; this wheel is 10 % faster, leans by half a degree and stays up.`,
    },
    {
      label: 'Just unstable',
      stop: 10,
      values: {...upright, phi_dot_start: -0.9 * limit},
      about: `Upright rolling is stable above ${
          limit.toFixed(2)} rad/s; this wheel is 10 % slower, leans as much and tumbles.`,
    },
    {
      label: 'Thin disc',
      stop: 10,
      values: {r: 0, theta_start: 20 * DEGREE, psi_dot_start: 9, phi_dot_start: -9},
      about: 'No tube (r = 0): the rolling disc of the textbooks, low and wobbling like a coin.',
    },
    {
      label: 'Driven',
      stop: 10,
      values: {theta_start: 88 * DEGREE, phi_dot_start: -4},
      changes: [
        {t: 1, name: 'M_3', value: -4}, {t: 3, name: 'M_3', value: 0}, {t: 6, name: 'M_brake', value: 4},
        {t: 7.5, name: 'M_brake', value: 0}
      ],
      about: 'A motor pushes with M₃ = −4 N m from 1 s to 3 s, and the brake acts with 4 N m from 6 s to 7.5 s.',
    },
  ];
}
