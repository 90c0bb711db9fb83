/* Equations of the quarter car; see quarter_car.h for axes and symbols.
 *
 *   F   = k (r_B - r_O - (0, 0, l_0)) + c (v_B - v_O)         link force on the wheel, each axis its own k, c
 *   M_1 = -k_theta (theta - theta_0) - c_theta theta_dot      camber, M_2 alike with psi (toe)
 *   m_B a_B = -F - (0, 0, m_B g)
 * Before t_couple the links carry nothing and B waits: a master that begins with all inputs at zero, as fmpy's SSP
 * simulation does, then does no harm. From t_drive on the hub motor gives M_drive. */
#include "quarter_car.h"

#include <math.h>
#include <string.h>

static const double rounding = 1e-9;   /* s: a switching time counts as reached this much early */
static const double inner_step = 5e-4; /* s: Runge-Kutta's error over 3 s is then below 1e-10 m (14 rad/s at most) */

static int coupled(const QuarterCar* car) { return car->t >= car->stored[t_couple] - rounding; }

void quarter_car_reset(QuarterCar* car) {
  static const double start[first_output] = {[m_B] = 300,
                                             [g] = 9.81,
                                             [k_h] = 60e3,
                                             [c_h] = 2000,
                                             [k_v] = 20e3,
                                             [c_v] = 1500,
                                             [l_0] = 0.5,
                                             [k_theta] = 8000,
                                             [c_theta] = 150,
                                             [theta_0] = 1.5358897417550099,
                                             [k_psi] = 2000,
                                             [c_psi] = 40,
                                             [psi_0] = 0,
                                             [M_drive] = -150,
                                             [t_drive] = 0.5,
                                             [t_couple] = 0.1,
                                             [Z_B_start] = 0.72,
                                             [Z_O] = 0.35,
                                             [theta] = 1.5707963267948966};
  memset(car, 0, sizeof *car);
  memcpy(car->stored, start, sizeof start);
}

void quarter_car_start(QuarterCar* car) {
  for (int i = 0; i < 3; ++i) car->position[i] = car->stored[X_B_start + i], car->velocity[i] = 0;
}

/* Link force at tau after the last communication point, with B at x and v. */
static double link_force(const QuarterCar* car, int axis, double tau, double x, double v) {
  const double* p = car->stored;
  const double k = p[axis < 2 ? k_h : k_v], c = p[axis < 2 ? c_h : c_v];
  const double r_O = p[X_O + axis] + tau * car->slope[X_O + axis - first_input];
  const double v_O = p[X_O_dot + axis] + tau * car->slope[X_O_dot + axis - first_input];
  return k * (x - r_O - (axis == 2 ? p[l_0] : 0)) + c * (v - v_O);
}

static double acceleration(const QuarterCar* car, int axis, double tau, double x, double v) {
  const double weight = axis == 2 ? car->stored[g] : 0;
  return -link_force(car, axis, tau, x, v) / car->stored[m_B] - weight;
}

/* Classical Runge-Kutta of fourth order; the axes do not couple. */
static void axis_step(QuarterCar* car, int axis, double tau, double h) {
  const double x = car->position[axis], v = car->velocity[axis];
  const double a1 = acceleration(car, axis, tau, x, v);
  const double v2 = v + h / 2 * a1, a2 = acceleration(car, axis, tau + h / 2, x + h / 2 * v, v2);
  const double v3 = v + h / 2 * a2, a3 = acceleration(car, axis, tau + h / 2, x + h / 2 * v2, v3);
  const double v4 = v + h * a3, a4 = acceleration(car, axis, tau + h, x + h * v3, v4);
  car->position[axis] = x + h / 6 * (v + 2 * v2 + 2 * v3 + v4);
  car->velocity[axis] = v + h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
}

void quarter_car_step(QuarterCar* car, double h) {
  const int n = (int)ceil(h / inner_step - 1e-6);
  for (int i = 0; coupled(car) && i < n; ++i)
    for (int axis = 0; axis < 3; ++axis) axis_step(car, axis, i * h / n, h / n);
  for (int i = 0; i < input_count; ++i) {
    car->stored[first_input + i] += h * car->slope[i];
    car->slope[i] = 0;
  }
  car->t += h;
}

/* -k (angle - rest) - c rate */
static double carrier_moment(const QuarterCar* car, int k, int c, int rest, int angle, int rate) {
  const double* p = car->stored;
  return -p[k] * (p[angle] - p[rest]) - p[c] * p[rate];
}

double quarter_car_value(const QuarterCar* car, unsigned variable) {
  if (variable < first_output) return car->stored[variable];
  if (variable >= X_B_dot) return car->velocity[variable - X_B_dot];
  if (variable >= X_B) return car->position[variable - X_B];
  if (variable == M_3) return car->t >= car->stored[t_drive] - rounding ? car->stored[M_drive] : 0;
  if (!coupled(car)) return 0;
  if (variable == M_1) return carrier_moment(car, k_theta, c_theta, theta_0, theta, theta_dot);
  if (variable == M_2) return carrier_moment(car, k_psi, c_psi, psi_0, psi, psi_dot);
  const int axis = (int)variable - F_X;
  return link_force(car, axis, 0, car->position[axis], car->velocity[axis]);
}

double quarter_car_rate(const QuarterCar* car, unsigned variable) {
  const double *p = car->stored, *slope = car->slope - first_input;
  if (variable < first_output || variable == M_3 || !coupled(car)) return 0;
  if (variable == M_1) return -p[k_theta] * slope[theta] - p[c_theta] * slope[theta_dot];
  if (variable == M_2) return -p[k_psi] * slope[psi] - p[c_psi] * slope[psi_dot];
  const int axis = ((int)variable - F_X) % 3;
  const double v = car->velocity[axis], a = acceleration(car, axis, 0, car->position[axis], v);
  if (variable >= X_B_dot) return a;
  if (variable >= X_B) return v;
  const double k = p[axis < 2 ? k_h : k_v], c = p[axis < 2 ? c_h : c_v];
  return k * (v - slope[X_O + axis]) + c * (a - slope[X_O_dot + axis]);
}
