/* The law of friction about the axle at one instant, shared by both formulations: tau = -(s N + brake) kappa. */
#ifndef WHEEL_FRICTION_H
#define WHEEL_FRICTION_H

#include <math.h>

#include "wheel_equations.h"

/* kappa, the direction of the friction; NaN without a law. The moment on a held wheel follows from omega_z_dot = 0. */
static inline double kappa_of(const WheelFriction* friction, double omega_z) {
  if (friction->kind == WHEEL_ROLLING) return friction->sigma;
  if (friction->kind == WHEEL_REGULARIZED) return tanh(omega_z / friction->omega_s);
  return friction->kind == WHEEL_FRICTIONLESS || friction->kind == WHEEL_HELD ? 0.0 : NAN;
}

#endif
