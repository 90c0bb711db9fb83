/* Equations of the driver. Fixed axes X, Y; angles to the left.
 *
 * Paths P(p), which begin at the origin along X:
 *   figure of eight  size sin p (1, cos p) / D, D = 1 + cos^2 p, turned by -45 degrees (Bernoulli's lemniscate):
 *                    |dP/dp| = size / sqrt(D), kappa = -3 sin p / (size sqrt(D))
 *   lane change      (p, width / 2 (tanh((p - x_out) / length) - tanh((p - x_back) / length)))
 * The parameter follows the car, p' = (velocity + k_p (r - P)) t / |dP/dp| with t the path's direction. With e the
 * distance to the left of the path, and the path's curvature kappa taken where the car will be after the lag T_delta:
 *
 *   delta_ref = atan(L (kappa - k_y e - k_psi sin(psi - heading))) + programme,   delta' = (delta_ref - delta) /
 * T_delta M_drive = k_v (v_ref - v) + k_i integral (v_ref - v) + programme
 *
 * All programmes rise by q(x) = x^3 (10 - 15 x + 6 x^2), which has continuous second derivatives. */
#include <math.h>
#include <string.h>

#include "model.h"

enum { x_delta, x_integral, x_p, state_count };
const int model_state_count = state_count;
static const double k_p = 4; /* 1/s */

typedef struct Place {
  double X, Y, dX, dY, kappa; /* of the path; dX, dY by p */
} Place;

const char* model_derive(const double* u, double* d) {
  return u[path] == 0 || u[path] == 1 || u[path] == 2 ? 0 : "path must be 0, 1 or 2.";
}

void model_start(const Now* now, double* x) { memset(x, 0, state_count * sizeof *x); }

static double rise(double t, double from, double duration) {
  const double z = fmin(fmax((t - from) / duration, 0), 1);
  return z * z * z * (10 - 15 * z + 6 * z * z);
}

static Place eight(double A, double p) {
  static const double turn = 0.70710678118654752440; /* cos 45 degrees */
  const double s = sin(p), c = cos(p), D = 1 + c * c;
  const double x = A * s / D, y = x * c, dx = A * c * (3 - c * c) / (D * D), dy = A * (3 * c * c - 1) / (D * D);
  return (Place){turn * (x + y), turn * (y - x), turn * (dx + dy), turn * (dy - dx), -3 * s / (A * sqrt(D))};
}

static Place lane(const double* u, double p) {
  const double a = tanh((p - u[x_out]) / u[length]), b = tanh((p - u[x_back]) / u[length]);
  const double h = u[width] / 2, l = u[length], dy = h / l * (b * b - a * a);
  const double ddy = 2 * h / (l * l) * (b * (1 - b * b) - a * (1 - a * a));
  return (Place){p, h * (a - b), 1, dy, ddy / pow(hypot(1, dy), 3)};
}

static Place place(const double* u, double p) {
  if (u[path] == 1) return eight(u[size], p);
  return lane(u, p);
}

static double off_path(const double* u, Place at) {
  return ((u[Y_R] - at.Y) * at.dX - (u[X_R] - at.X) * at.dY) / hypot(at.dX, at.dY);
}

static double p_rate(const double* u, Place at) {
  const double vx = u[v] * cos(u[psi]) + k_p * (u[X_R] - at.X), vy = u[v] * sin(u[psi]) + k_p * (u[Y_R] - at.Y);
  return (vx * at.dX + vy * at.dY) / (at.dX * at.dX + at.dY * at.dY);
}

static double steer_rate(const Now* now, const double* x) {
  const double* u = now->u;
  double wanted = u[delta_0] * rise(now->t, u[t_delta], u[ramp_delta]);
  if (u[path] != 0) {
    const Place at = place(u, x[x_p]);
    const double ahead = place(u, x[x_p] + u[T_delta] * u[v] / hypot(at.dX, at.dY)).kappa;
    const double turned = sin(u[psi] - atan2(at.dY, at.dX));
    wanted += atan(u[L] * (ahead - u[k_y] * off_path(u, at) - u[k_psi] * turned));
  }
  return (wanted - x[x_delta]) / u[T_delta];
}

static double speed_error(const Now* now) {
  const double* u = now->u;
  return u[v_0] + (u[v_1] - u[v_0]) * rise(now->t, u[t_v], u[ramp_v]) - u[v];
}

void model_rates(const Now* now, const double* x, double* x_dot) {
  x_dot[x_delta] = steer_rate(now, x);
  x_dot[x_integral] = speed_error(now);
  x_dot[x_p] = now->u[path] != 0 ? p_rate(now->u, place(now->u, x[x_p])) : 0;
}

void model_outputs(const Now* now, const double* x, double* y) {
  const double *u = now->u, t = now->t;
  y[delta] = x[x_delta];
  y[delta_dot] = steer_rate(now, x);
  y[M_drive] = u[k_v] * speed_error(now) + u[k_i] * x[x_integral];
  y[M_drive] += u[M_0] * (rise(t, u[t_on], u[ramp_M]) - rise(t, u[t_off], u[ramp_M]));
  /* 1 - q(x) = q(1 - x), which is never below 0. */
  y[M_brake] = u[B_0] * rise(t, u[t_brake], u[ramp_M]) + u[B_hold] * rise(-t, -u[t_release] - u[ramp_M], u[ramp_M]);
  y[p] = x[x_p];
  y[off] = u[path] != 0 ? off_path(u, place(u, x[x_p])) : 0;
}
