/* The hub's equations; hub.h has them in words. */
#include "hub.h"

#include <math.h>
#include <string.h>

#include "vector.h"

enum { r_O = 0, v_O = 3, psi = 6, theta, psi_dot, theta_dot };

static void carrier_axes(const double* pose, Hub* hub) {
  const double sp = sin(pose[psi]), cp = cos(pose[psi]), st = sin(pose[theta]), ct = cos(pose[theta]);
  const double e1[3] = {cp, sp, 0}, e2[3] = {-ct * sp, ct * cp, st}, e3[3] = {st * sp, -st * cp, ct};
  memcpy(hub->e1, e1, sizeof e1);
  memcpy(hub->e2, e2, sizeof e2);
  memcpy(hub->e3, e3, sizeof e3);
}

static void displacement(const double* pose, const Body* body, const double p[3], Hub* hub) {
  double away[3], velocity[3], turning[3];
  for (int i = 0; i < 3; ++i) away[i] = pose[r_O + i] - body->r[i], velocity[i] = pose[v_O + i] - body->v[i];
  to_body((double (*)[3])body->R, away, hub->arm);
  to_body((double (*)[3])body->R, velocity, hub->d_dot);
  cross(body->w, hub->arm, turning);
  for (int i = 0; i < 3; ++i) hub->d[i] = hub->arm[i] - p[i], hub->d_dot[i] -= turning[i];
}

/* With u = n e1 and w = n e2: e3 x n = -w e1 + u e2. */
static void moments(const double* pose, const Body* body, Steer steer, Bushing bushing, Hub* hub) {
  const double n_body[3] = {sin(steer.angle), -cos(steer.angle), 0};
  const double turn_body[3] = {body->w[0], body->w[1], body->w[2] + steer.rate};
  double n[3], turn[3];
  to_fixed((double (*)[3])body->R, n_body, n);
  to_fixed((double (*)[3])body->R, turn_body, turn);
  const double rate_1 = pose[theta_dot] - dot(turn, hub->e1);
  const double rate_2 = pose[psi_dot] * sin(pose[theta]) - dot(turn, hub->e2);
  hub->M_1 = -bushing.k_a * dot(n, hub->e2) - bushing.c_a * rate_1;
  hub->M_2 = bushing.k_a * dot(n, hub->e1) - bushing.c_a * rate_2;
  hub->turn_rate2 = rate_1 * rate_1 + rate_2 * rate_2;
  const double off[3] = {n[0] - hub->e3[0], n[1] - hub->e3[1], n[2] - hub->e3[2]};
  hub->bent = dot(off, off) / 2;
}

void hub_read(const double* pose, const Body* body, const double p[3], Steer steer, Bushing bushing, Hub* hub) {
  memset(hub, 0, sizeof *hub);
  carrier_axes(pose, hub);
  displacement(pose, body, p, hub);
  moments(pose, body, steer, bushing, hub);
}

void hub_react(const Hub* hub, Body* body) {
  const double f[3] = {-hub->f[0], -hub->f[1], -hub->f[2]};
  double M[3], M_body[3];
  body_pull(body, hub->arm, f);
  for (int i = 0; i < 3; ++i) M[i] = hub->M_1 * hub->e1[i] + hub->M_2 * hub->e2[i] + hub->M_3 * hub->e3[i];
  to_body(body->R, M, M_body);
  for (int i = 0; i < 3; ++i) body->M[i] -= M_body[i];
}

void hub_load(const Hub* hub, const Body* body, double load[5]) {
  to_fixed((double (*)[3])body->R, hub->f, load);
  load[3] = hub->M_1, load[4] = hub->M_2;
}
