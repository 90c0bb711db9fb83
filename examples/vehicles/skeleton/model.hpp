/* What an example gives to the skeleton: its equations as functions of time, stored values and states.
 *
 * `u` holds parameters and inputs, `y` the outputs and locals from first_output on; both are indexed by value
 * reference, whose names are generated from the example's table of variables (variables.hpp). `d` is what follows from
 * the parameters alone. No function keeps anything between calls. SI units. */
#pragma once

#include <Eigen/Core>

#include "variables.hpp"

enum { max_states = 16, max_derived = 32 };

using States = Eigen::Vector<double, max_states>;

struct Now {
  double t;               /* s */
  double begin;           /* the last communication point, s: what switches with time does so there */
  double u[first_output]; /* parameters and inputs */
  double d[max_derived];  /* derived once, at the start */
};

/* Whether the time held by the parameter `time` had come at the last communication point, within rounding. */
inline bool reached(const Now& now, int time) { return now.begin >= now.u[time] - 1e-9; }

/* Whether the height `Z`, an input, has been received: a point at height 0 lies in the road, and some masters begin
 * with all inputs at zero. */
inline bool received(const double* u, int Z) { return u[Z] > 0; }

/* Derived quantities from the parameters; throws std::invalid_argument with the message of a wrong parameter. */
void model_derive(const double* u, double* d);
States model_start(const Now& now);
States model_rates(const Now& now, const States& x);
void model_outputs(const Now& now, const States& x, double* y);
