/* Equations of the axle: a rigid beam (mechanics/rigid_body.h) on two hubs (mechanics/hub.h).
 *
 * Body axes x forward, y left, z up, origin in the centre of mass B, which lies `a` ahead of the axle's line; the hubs
 * at p = (-a, +-b, 0). Each hub carries half of the weight without being displaced. The torque M of a wheel acts
 * between the wheel and the beam; a support against the horizon keeps the beam from turning about the axle:
 *
 *   M_support = (m_B g a - k_p s - c_p w u) u,   u = x cross Z,   s = x Z, the sine of the pitch, nose up
 *
 * x and Z are the beam's forward axis and the road's normal, g the part of gravity along it; m_B g a is what the weight
 * ahead of the axle needs.
 * Until t_couple the beam runs on straight and the hubs carry the weight alone. */
#include <math.h>

#include "vector.h"
#include "vehicle.h"

enum { x_loss = vehicle_states, state_count };
const int model_state_count = state_count;

const char* model_derive(const double* u, double* d) {
  gravity(u[g], u[slope], u[slope_direction], d + at_g);
  return 0;
}

void model_start(const Now* now, double* x) {
  const double* u = now->u;
  const double c = cos(u[psi_start]), s = sin(u[psi_start]);
  const double r[3] = {u[X_start] + u[a] * c, u[Y_start] + u[a] * s, u[R]};
  body_place(x, r, u[psi_start], u[v_start]);
  x[body_v] -= u[omega_start] * u[a] * s;
  x[body_v + 1] += u[omega_start] * u[a] * c;
  x[body_w + 2] = u[omega_start];
  x[x_loss] = 0;
  x[x_psi] = u[psi_start];
}

void hubs(const Now* now, const Body* body, Hub hub[wheel_count]) {
  const double* u = now->u;
  const Bushing bushing = {u[k_a], u[c_a]};
  for (int i = 0; i < wheel_count; ++i) {
    const double p[3] = {-u[a], i ? -u[b] : u[b], 0};
    const double share = u[m_B] * now->d[at_g + 2] / wheel_count;
    hub_read(u + X_O_each + i * wheel_inputs, body, p, (Steer){0, 0}, bushing, &hub[i]);
    const int coupled = reached(now, t_couple);
    if (!coupled) hub[i].M_1 = hub[i].M_2 = 0;
    hub[i].M_3 = -u[M_each + i * wheel_parameters];
    for (int j = 0; j < 3; ++j) hub[i].f[j] = coupled ? -u[k] * hub[i].d[j] - u[c] * hub[i].d_dot[j] : 0;
    hub[i].f[2] += share;
  }
}

/* The support against the horizon; returns the power that its damper takes. */
static double support(const Now* now, Body* body) {
  const double* u = now->u;
  const double s = body->R[2][0], forward[3] = {1, 0, 0};
  const double up[3] = {body->R[2][0], body->R[2][1], body->R[2][2]};
  double axis[3];
  cross(forward, up, axis);
  const double rate = dot(body->w, axis);
  const double M = -u[m_B] * now->d[at_g + 2] * u[a] - u[k_p] * s - u[c_p] * rate;
  for (int i = 0; i < 3; ++i) body->M[i] += M * axis[i];
  return u[c_p] * rate * rate;
}

void further(const Now* now, const Hub hub[wheel_count], Body* body, double* x_dot) {
  const double* u = now->u;
  x_dot[x_loss] = support(now, body);
  for (int i = 0; i < wheel_count; ++i)
    x_dot[x_loss] += u[c] * dot(hub[i].d_dot, hub[i].d_dot) + u[c_a] * hub[i].turn_rate2;
}

/* Kinetic and potential energy; the constant shares of the weight, and M_0, are potentials too. */
static double energy(const Now* now, const Body* body, const Hub hub[wheel_count]) {
  const double* u = now->u;
  const double J[3] = {u[J_1], u[J_2], u[J_3]}, s = body->R[2][0];
  const double above[3] = {body->r[0], body->r[1], body->r[2] - u[R]};
  double e = u[m_B] * (dot(body->v, body->v) / 2 - dot(now->d + at_g, above));
  for (int i = 0; i < 3; ++i) e += J[i] * body->w[i] * body->w[i] / 2;
  e += u[k_p] * s * s / 2 + u[m_B] * now->d[at_g + 2] * u[a] * s;
  for (int i = 0; i < wheel_count; ++i) {
    e += u[k] * dot(hub[i].d, hub[i].d) / 2 + u[k_a] * hub[i].bent;
    e -= u[m_B] * now->d[at_g + 2] / wheel_count * hub[i].d[2];
  }
  return e;
}

void model_outputs(const Now* now, const double* x, double* y) {
  const double* u = now->u;
  Body body;
  Hub hub[wheel_count];
  body_read(x, &body);
  hubs(now, &body, hub);
  const double middle[3] = {-u[a], 0, 0};
  const Track track = body_track(&body, middle, x[x_psi]);
  y[X] = track.X, y[Y] = track.Y, y[psi] = track.psi, y[v] = track.v, y[omega] = track.omega;
  for (int i = 0; i < wheel_count; ++i) {
    double* of = y + F_X_each + i * wheel_outputs;
    hub_load(&hub[i], &body, of);
    of[5] = hub[i].M_3;
  }
  y[E] = energy(now, &body, hub);
  y[W_loss] = x[x_loss];
}
