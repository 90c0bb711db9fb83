/* Runge-Kutta of fourth order with a fixed inner step, and output derivatives by a difference along the motion. */
#include "simulation.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

void simulation_reset(Simulation* s) {
  memset(s, 0, sizeof *s);
  for (int i = 0; i < first_output; ++i) s->now.u[i] = stored[i].start;
}

const char* simulation_start(Simulation* s, char sentence[sentence_size]) {
  for (int i = 0; i < first_output; ++i) {
    const double value = s->now.u[i];
    if (!stored[i].limit || value > 0 || (value == 0 && stored[i].limit == 1)) continue;
    const char* limit = stored[i].limit == 1 ? "at least" : "above";
    snprintf(sentence, sentence_size, "%s = %g: it must be %s 0 %s.", stored[i].name, value, limit, stored[i].unit);
    return sentence;
  }
  const char* fault = model_derive(s->now.u, s->now.d);
  if (!fault) model_start(&s->now, s->x);
  return fault;
}

/* The instant tau after the last communication point: the inputs on their polynomials. */
static Now later(const Simulation* s, double tau) {
  Now now = s->now;
  now.t += tau;
  for (int i = 0; i < input_count; ++i)
    now.u[first_input + i] += tau * (s->slope[0][i] + tau / 2 * (s->slope[1][i] + tau / 3 * s->slope[2][i]));
  return now;
}

/* y = x + h f */
static void add(const double* x, double h, const double* f, double* y) {
  for (int i = 0; i < model_state_count; ++i) y[i] = x[i] + h * f[i];
}

static void inner(Simulation* s, const Now* begin, const Now* middle, const Now* end, double h) {
  double k1[max_states], k2[max_states], k3[max_states], k4[max_states], x[max_states];
  model_rates(begin, s->x, k1);
  add(s->x, h / 2, k1, x);
  model_rates(middle, x, k2);
  add(s->x, h / 2, k2, x);
  model_rates(middle, x, k3);
  add(s->x, h, k3, x);
  model_rates(end, x, k4);
  for (int i = 0; i < model_state_count; ++i) s->x[i] += h / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
}

static void follow_rates(Simulation* s) {
  for (int i = 0; i < input_count; ++i)
    if (rate_of[i] >= 0 && !s->given[i]) s->slope[0][i] = s->now.u[first_input + rate_of[i]];
}

void simulation_step(Simulation* s, double h) {
  if (s->now.u[follow] != 0) follow_rates(s);
  const int n = (int)fmax(1, ceil(h / s->now.u[inner_step] - 1e-6));
  Now begin = s->now;
  for (int i = 0; i < n; ++i) {
    const Now middle = later(s, h * (i + 0.5) / n), end = later(s, h * (i + 1) / n);
    inner(s, &begin, &middle, &end, h / n);
    begin = end;
  }
  s->now = begin;
  s->now.begin = s->now.t;
  memset(s->slope, 0, sizeof s->slope);
  memset(s->given, 0, sizeof s->given);
}

void simulation_outputs(const Simulation* s, double* y) { model_outputs(&s->now, s->x, y); }

/* (y(x + e f, u + e u', t + e) - y(x - e f, ...)) / 2 e: the outputs are nearly linear along so short a line, so the
 * error is rounding, some 1e-12 of y per second. */
void simulation_output_rates(const Simulation* s, double* y_dot) {
  static const double e = 1e-4; /* s */
  double f[max_states], x[max_states], before[variable_count];
  Simulation line = *s;
  if (line.now.u[follow] != 0) follow_rates(&line);
  model_rates(&s->now, s->x, f);
  memset(line.slope[1], 0, sizeof line.slope[1] * (input_orders - 1));
  Now now = later(&line, -e);
  add(s->x, -e, f, x);
  model_outputs(&now, x, before);
  now = later(&line, e);
  add(s->x, e, f, x);
  model_outputs(&now, x, y_dot);
  for (int i = first_output; i < variable_count; ++i) y_dot[i] = (y_dot[i] - before[i]) / (2 * e);
}
