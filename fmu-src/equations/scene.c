/* What acts on a wheel: a load, a law of rolling resistance, which is checked, and the slope of the road. */
#include <math.h>

#include "wheel_equations.h"

/* Written so that NaN is refused too. */
static int is_meant(const WheelParameters* wheel, double brake, const WheelFriction* friction) {
  if (!(wheel->s >= 0 && brake >= 0)) return 0;
  if (friction->kind == WHEEL_ROLLING) return friction->sigma == 1 || friction->sigma == -1;
  if (friction->kind == WHEEL_REGULARIZED) return friction->omega_s > 0;
  return friction->kind == WHEEL_FRICTIONLESS || friction->kind == WHEEL_HELD;
}

double wheel_kappa(const WheelFriction* friction, double omega_z) {
  if (friction->kind == WHEEL_ROLLING) return friction->sigma;
  if (friction->kind == WHEEL_REGULARIZED) return tanh(omega_z / friction->omega_s);
  return friction->kind == WHEEL_FRICTIONLESS || friction->kind == WHEEL_HELD ? 0.0 : NAN;
}

WheelScene wheel_scene(const WheelParameters* wheel, const WheelLoad* load, WheelFriction friction) {
  WheelScene scene = {.wheel = *wheel, .friction = friction};
  if (load) scene.load = *load;
  if (!is_meant(wheel, scene.load.brake, &friction)) scene.friction.kind = WHEEL_NO_LAW;
  return scene;
}

void wheel_set_slope(WheelParameters* wheel, double g, double slope, double direction) {
  wheel->g_n = g * cos(slope);
  wheel->g_X = -g * sin(slope) * cos(direction);
  wheel->g_Y = -g * sin(slope) * sin(direction);
}
