/* Rates of a body on hubs; until t_couple it runs on straight. */
#include "vehicle.h"

#include <string.h>

void model_rates(const Now* now, const double* x, double* x_dot) {
  const double* u = now->u;
  const double J[3] = {u[J_1], u[J_2], u[J_3]};
  Body body;
  Hub hub[wheel_count];
  body_read(x, &body);
  memset(x_dot, 0, (size_t)model_state_count * sizeof *x_dot);
  if (!reached(now, t_couple)) {
    memcpy(x_dot + body_r, body.v, sizeof body.v);
    return;
  }
  hubs(now, &body, hub);
  for (int i = 0; i < wheel_count; ++i) hub_react(&hub[i], &body);
  further(now, hub, &body, x_dot);
  body_rates(x, &body, u[m_B], J, now->d + at_g, x_dot);
  x_dot[x_psi] = body.w_fixed[2];
}
