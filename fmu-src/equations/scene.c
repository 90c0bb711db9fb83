/* The law of friction; makes a scene of a wheel, a load and a law, and checks the law; puts a wheel on a slope; turns
 * taken off an angle. */
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

double wheel_less_turns(double angle) {
  const double pi = 3.141592653589793;
  if (fabs(angle) <= pi) return angle;
  /* The nearest multiple of a rounded 2 pi is off by less than 1e-4 rad; sine and cosine of the whole angle are not. */
  double rest = remainder(angle, 2 * pi);
  for (int i = 0; i < 2; ++i) rest += sin(angle) * cos(rest) - cos(angle) * sin(rest);
  return rest;
}

double wheel_angle_of(double x, double y) {
  double size = sqrt(x * x + y * y), angle = x < 0 ? copysign(3.141592653589793, y) : 0;
  if (size == 0) return 0;
  /* The rest is less than a quarter turn; each time its sine is taken off. */
  for (int i = 0; i < 6; ++i) angle += y / size * cos(angle) - x / size * sin(angle);
  return angle;
}

void wheel_set_slope(WheelParameters* wheel, double g, double slope, double direction) {
  wheel->g = g * cos(slope);
  wheel->g_X = -g * sin(slope) * cos(direction);
  wheel->g_Y = -g * sin(slope) * sin(direction);
}
