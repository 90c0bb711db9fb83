/* Equations of the chassis: a rigid body (mechanics/rigid_body.h) on one hub (mechanics/hub.h) and strut per wheel.
 *
 * Body axes x forward, y left, z up, origin in the centre of mass B at the height h_B; the hub of wheel i at rest at
 * p = (x_i, y_i, R - h_B). Along x and y of the chassis the hub's bushing holds the wheel; along z the strut, with d
 * the wheel's way up from rest, e the way beyond the free travel, and F_i its share of the weight:
 *
 *   f_z = -(F_i + k d + c d' + k_stop |e| e + k_bar (d - d_other end of the bar))
 *
 * Steering (Ackermann): all wheels turn about one point on the line through the wheels that are not steered. With L
 * from that line to the steered wheels, tan delta_i = (x_i - x_R) tan delta / (L - y_i tan delta). Drive: M_3 = -share
 * M_drive, taken from the chassis. Brake: of the moment tau that the wheel feels, the share B / (s N + B) is the
 * brake's, which the chassis carries; B is its capacity, s N that of rolling friction. Until t_couple the chassis runs
 * on straight and each strut gives F_i alone. */
#include <math.h>

#include "vehicle.h"

enum { at_share = vehicle_derived, at_x_R = at_share + wheel_count, at_L, derived_count };
const int model_state_count = vehicle_states;
_Static_assert((int)derived_count <= (int)max_derived, "too many wheels");

static const double* of_wheel(const double* u, int first, int i) { return u + first + i * wheel_parameters; }

/* Shares of the weight F_i = p + q x_i + r y_i in balance: sum F_i = m g cos(slope), sum x_i F_i = sum y_i F_i = 0. */
static int weigh(const double* u, double* share) {
  double A[3][4] = {{0, 0, 0, u[m_B] * u[g] * cos(u[slope])}};
  for (int i = 0; i < wheel_count; ++i) {
    const double z[3] = {1, *of_wheel(u, x_each, i), *of_wheel(u, y_each, i)};
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k) A[j][k] += z[j] * z[k];
  }
  for (int j = 0; j < 3; ++j) { /* Gauss-Jordan: the matrix is positive definite unless the hubs lie on one line */
    if (!(A[j][j] > 1e-9)) return 0;
    for (int i = 0; i < 3; ++i) {
      const double f = A[i][j] / A[j][j];
      for (int k = 0; i != j && k < 4; ++k) A[i][k] -= f * A[j][k];
    }
  }
  for (int i = 0; i < wheel_count; ++i)
    share[i] =
        A[0][3] / A[0][0] + *of_wheel(u, x_each, i) * A[1][3] / A[1][1] + *of_wheel(u, y_each, i) * A[2][3] / A[2][2];
  return 1;
}

const char* model_derive(const double* u, double* d) {
  gravity(u[g], u[slope], u[slope_direction], d + at_g);
  if (!weigh(u, d + at_share)) return "The hubs must not lie on one line.";
  double x[2] = {0, 0}, n[2] = {0, 0};
  for (int i = 0; i < wheel_count; ++i) {
    const int steered = *of_wheel(u, steer_each, i) > 0.5;
    x[steered] += *of_wheel(u, x_each, i), n[steered] += 1;
    if (!(d[at_share + i] > 0)) return "The centre of mass must lie between the wheels.";
  }
  if (n[0] == 0 || n[1] == 0) return "Some wheels must be steered, and some not.";
  d[at_x_R] = x[0] / n[0];
  d[at_L] = x[1] / n[1] - d[at_x_R];
  return d[at_L] != 0 ? 0 : "The steered wheels must not stand beside the others.";
}

void model_start(const Now* now, double* x) {
  const double* u = now->u;
  const double r[3] = {u[X_start], u[Y_start], u[h_B]};
  body_place(x, r, u[psi_start], u[v_start]);
  x[x_psi] = u[psi_start];
}

static Steer steering(const Now* now, int i) {
  const double* u = now->u;
  const double x = *of_wheel(u, x_each, i) - now->d[at_x_R], y = *of_wheel(u, y_each, i), L = now->d[at_L];
  const double t = tan(u[delta]), across = L - y * t, t_i = x * t / across;
  if (!(*of_wheel(u, steer_each, i) > 0.5)) return (Steer){0, 0};
  return (Steer){atan(t_i), x * L * (1 + t * t) / (across * across) / (1 + t_i * t_i) * u[delta_dot]};
}

/* Spring, damper and stops of one strut; positive where it pushes the wheel down. */
static double strut(const double* u, int i, double share, const Hub* hub) {
  const double d = hub->d[2], e = fmax(0, fabs(d) - u[travel]);
  return share + *of_wheel(u, k_each, i) * d + *of_wheel(u, c_each, i) * hub->d_dot[2] + copysign(u[k_stop] * e * e, d);
}

/* The part of tau that the brake gives. */
static double braking(const double* u, int i) {
  const double B = u[M_brake] * *of_wheel(u, brake_each, i);
  const double *tau = u + tau_each + i * wheel_inputs, *N = u + lambda_3_each + i * wheel_inputs;
  return B > 0 ? *tau * B / (B + u[s] * fmax(*N, 0)) : 0;
}

void hubs(const Now* now, const Body* body, Hub hub[wheel_count]) {
  const double* u = now->u;
  const Bushing bushing = {u[k_a], u[c_a]};
  const int coupled = reached(now, t_couple);
  for (int i = 0; i < wheel_count; ++i) {
    const double p[3] = {*of_wheel(u, x_each, i), *of_wheel(u, y_each, i), u[R] - u[h_B]};
    hub_read(u + X_O_each + i * wheel_inputs, body, p, steering(now, i), bushing, &hub[i]);
    hub[i].M_3 = braking(u, i) - u[M_drive] * *of_wheel(u, drive_each, i);
    hub[i].f[2] = -now->d[at_share + i];
    if (!coupled) {
      hub[i].M_1 = hub[i].M_2 = 0;
      continue;
    }
    for (int j = 0; j < 2; ++j) hub[i].f[j] = -u[k_h] * hub[i].d[j] - u[c_h] * hub[i].d_dot[j];
    hub[i].f[2] = -strut(u, i, now->d[at_share + i], &hub[i]);
  }
  for (int i = 0; coupled && i < wheel_count; ++i) {
    const int other = bar_partner[i];
    const double f = other < 0 ? 0 : *of_wheel(u, k_bar_each, i) * (hub[i].d[2] - hub[other].d[2]);
    hub[i].f[2] -= f;
    if (other >= 0) hub[other].f[2] += f;
  }
}

void further(const Now* now, const Hub hub[wheel_count], Body* body, double* x_dot) {}

static void pose_outputs(const Now* now, const double* x, const Body* body, double* y) {
  const double rear[3] = {now->d[at_x_R], 0, now->u[R] - now->u[h_B]};
  const Track track = body_track(body, rear, x[x_psi]);
  y[X] = body->r[0], y[Y] = body->r[1], y[Z] = body->r[2];
  y[roll] = asin(body->R[2][1]);
  y[pitch] = -asin(body->R[2][0]);
  y[X_R] = track.X, y[Y_R] = track.Y, y[psi] = track.psi, y[v] = track.v, y[omega] = track.omega;
}

void model_outputs(const Now* now, const double* x, double* y) {
  const double* u = now->u;
  Body body;
  Hub hub[wheel_count];
  body_read(x, &body);
  hubs(now, &body, hub);
  pose_outputs(now, x, &body, y);
  for (int i = 0; i < wheel_count; ++i) {
    double* of = y + F_X_each + i * wheel_outputs;
    hub_load(&hub[i], &body, of);
    of[5] = -u[M_drive] * *of_wheel(u, drive_each, i);
    of[6] = u[M_brake] * *of_wheel(u, brake_each, i);
    y[d_each + i * wheel_locals] = hub[i].d[2];
    y[delta_each + i * wheel_locals] = steering(now, i).angle;
  }
}
