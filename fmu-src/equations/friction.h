/* The law of friction about the axle at one instant, shared by both formulations: tau = -(s N + brake) kappa. */
#ifndef WHEEL_FRICTION_H
#define WHEEL_FRICTION_H

#include <math.h>

#include "wheel_equations.h"

/* kappa, the direction of the friction; NaN without a law. The moment on a held wheel follows from omega_z_dot = 0. */
static inline double kappa_of(const WheelFriction* friction, double omega_z) {
  switch (friction->kind) {
    case WHEEL_FRICTIONLESS:
    case WHEEL_HELD:
      return 0.0;
    case WHEEL_ROLLING:
      return friction->sigma;
    case WHEEL_REGULARIZED:
      return tanh(omega_z / friction->omega_s);
    case WHEEL_NO_LAW:
      break;
  }
  return NAN;
}

#endif
