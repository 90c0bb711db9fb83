/* What an example gives to the skeleton: its equations as functions of time, stored values and states.
 *
 * `u` holds parameters and inputs, `y` the outputs and locals from first_output on; both are indexed by value
 * reference, whose names are generated from the example's table of variables (variables.h). `d` is what follows from
 * the parameters alone. No function keeps anything between calls. SI units. */
#ifndef MODEL_H
#define MODEL_H

#include "variables.h"

enum { max_states = 32, max_derived = 32 };

typedef struct Now {
  double t;               /* s */
  double begin;           /* the last communication point, s: what switches with time does so there */
  double u[first_output]; /* parameters and inputs */
  double d[max_derived];  /* derived once, at the start */
} Now;

/* Whether the time held by the parameter `time` had come at the last communication point, within rounding. */
static inline int reached(const Now* now, int time) { return now->begin >= now->u[time] - 1e-9; }

extern const int model_state_count;

/* Derived quantities from the parameters; NULL, or one sentence that says which parameter is wrong. */
const char* model_derive(const double* u, double* d);
void model_start(const Now* now, double* x);
void model_rates(const Now* now, const double* x, double* x_dot);
void model_outputs(const Now* now, const double* x, double* y);

#endif
