/* Newton-Euler equations of one rigid body; rigid_body.h has the axes. */
#include "rigid_body.h"

#include <math.h>
#include <string.h>

#include "vector.h"

void body_place(double* x, const double r[3], double heading, double speed) {
  memset(x, 0, body_states * sizeof *x);
  memcpy(x + body_r, r, 3 * sizeof *x);
  x[body_q] = cos(heading / 2);
  x[body_q + 3] = sin(heading / 2);
  x[body_v] = speed * cos(heading);
  x[body_v + 1] = speed * sin(heading);
}

static void rotation(const double* q, double R[3][3]) {
  const double n = 2 / (q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  const double a = q[0], b = q[1], c = q[2], d = q[3];
  R[0][0] = 1 - n * (c * c + d * d), R[0][1] = n * (b * c - a * d), R[0][2] = n * (b * d + a * c);
  R[1][0] = n * (b * c + a * d), R[1][1] = 1 - n * (b * b + d * d), R[1][2] = n * (c * d - a * b);
  R[2][0] = n * (b * d - a * c), R[2][1] = n * (c * d + a * b), R[2][2] = 1 - n * (b * b + c * c);
}

void body_read(const double* x, Body* body) {
  memset(body, 0, sizeof *body);
  rotation(x + body_q, body->R);
  memcpy(body->r, x + body_r, sizeof body->r);
  memcpy(body->v, x + body_v, sizeof body->v);
  memcpy(body->w, x + body_w, sizeof body->w);
  to_fixed(body->R, body->w, body->w_fixed);
}

Track body_track(const Body* body, const double p[3], double near) {
  const double heading = atan2(body->R[1][0], body->R[0][0]);
  double turning[3], arm[3], velocity[3];
  cross(body->w, p, turning);
  to_fixed((double (*)[3])body->R, p, arm);
  to_fixed((double (*)[3])body->R, turning, velocity);
  for (int i = 0; i < 3; ++i) velocity[i] += body->v[i];
  return (Track){.X = body->r[0] + arm[0],
                 .Y = body->r[1] + arm[1],
                 .psi = near + remainder(heading - near, 6.283185307179586),
                 .v = velocity[0] * cos(heading) + velocity[1] * sin(heading),
                 .omega = body->w_fixed[2]};
}

void body_pull(Body* body, const double arm[3], const double f[3]) {
  double F[3], M[3];
  to_fixed(body->R, f, F);
  cross(arm, f, M);
  for (int i = 0; i < 3; ++i) body->F[i] += F[i], body->M[i] += M[i];
}

void gravity(double g, double slope, double direction, double a[3]) {
  a[0] = -g * sin(slope) * cos(direction);
  a[1] = -g * sin(slope) * sin(direction);
  a[2] = -g * cos(slope);
}

/* J w' = M - w x J w;  q' = q (0, w) / 2 */
void body_rates(const double* x, const Body* body, double m, const double J[3], const double g[3], double* x_dot) {
  const double* q = x + body_q;
  const double* w = body->w;
  const double H[3] = {J[0] * w[0], J[1] * w[1], J[2] * w[2]};
  double gyro[3];
  cross(w, H, gyro);
  for (int i = 0; i < 3; ++i) {
    x_dot[body_r + i] = body->v[i];
    x_dot[body_v + i] = body->F[i] / m + g[i];
    x_dot[body_w + i] = (body->M[i] - gyro[i]) / J[i];
  }
  x_dot[body_q] = -(q[1] * w[0] + q[2] * w[1] + q[3] * w[2]) / 2;
  x_dot[body_q + 1] = (q[0] * w[0] + q[2] * w[2] - q[3] * w[1]) / 2;
  x_dot[body_q + 2] = (q[0] * w[1] + q[3] * w[0] - q[1] * w[2]) / 2;
  x_dot[body_q + 3] = (q[0] * w[2] + q[1] * w[1] - q[2] * w[0]) / 2;
}
