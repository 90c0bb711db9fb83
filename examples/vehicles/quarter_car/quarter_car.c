/* Quarter car: a sprung mass B above the wheel's centre O, linked to it by springs and dampers without mass. B does not
 * turn; the hub carrier gives the moments M_1 (camber) and M_2 (toe) along the wheel's carrier axes, the hub motor M_3
 * about the axle. Fixed axes X, Y, Z, Z up.
 *
 *   F   = k (r_B - r_O - (0, 0, l_0)) + c (v_B - v_O)         link force on the wheel, each axis its own k, c
 *   M_1 = -k_theta (theta - theta_0) - c_theta theta_dot      camber, M_2 alike with psi (toe)
 *   m_B a_B = -F - (0, 0, m_B g)
 *
 * Before t_couple the links carry nothing and B waits: a master that begins with all inputs at zero, as fmpy's SSP
 * simulation does, then does no harm. From t_drive on the hub motor gives M_drive. */
#include <string.h>

#include "model.h"

enum { x_r = 0, x_v = 3, state_count = 6 };
const int model_state_count = state_count;

const char* model_derive(const double* u, double* d) { return 0; }

void model_start(const Now* now, double* x) {
  memset(x, 0, state_count * sizeof *x);
  memcpy(x, now->u + X_B_start, 3 * sizeof *x);
}

static double link_force(const Now* now, const double* x, int axis) {
  const double* u = now->u;
  const double k = u[axis < 2 ? k_h : k_v], c = u[axis < 2 ? c_h : c_v], rest = axis == 2 ? u[l_0] : 0;
  return k * (x[x_r + axis] - u[X_O + axis] - rest) + c * (x[x_v + axis] - u[X_O_dot + axis]);
}

void model_rates(const Now* now, const double* x, double* x_dot) {
  memset(x_dot, 0, state_count * sizeof *x_dot);
  for (int axis = 0; reached(now, t_couple) && axis < 3; ++axis) {
    x_dot[x_r + axis] = x[x_v + axis];
    x_dot[x_v + axis] = -link_force(now, x, axis) / now->u[m_B] - (axis == 2 ? now->u[g] : 0);
  }
}

void model_outputs(const Now* now, const double* x, double* y) {
  const double* u = now->u;
  const int coupled = reached(now, t_couple);
  for (int axis = 0; axis < 3; ++axis) {
    y[F_X + axis] = coupled ? link_force(now, x, axis) : 0;
    y[X_B + axis] = x[x_r + axis];
    y[X_B_dot + axis] = x[x_v + axis];
  }
  y[M_1] = coupled ? -u[k_theta] * (u[theta] - u[theta_0]) - u[c_theta] * u[theta_dot] : 0;
  y[M_2] = coupled ? -u[k_psi] * (u[psi] - u[psi_0]) - u[c_psi] * u[psi_dot] : 0;
  y[M_3] = reached(now, t_drive) ? u[M_drive] : 0;
}
