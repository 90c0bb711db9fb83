// Setup: all that follows from the parameters when initialization ends. One function computes it, nothing writes it
// later; a restored run computes it anew.
#pragma once

#include "demand.hpp"
#include "wheel_equations.h"

namespace wheel {

struct Setup {
  Kind kind;
  double start_time;  // s
  const WheelFormulation* formulation;
  WheelParameters wheel;  // its `s` is zero here: the one in force is part of the run
  FrictionLaw friction_law = exact_law;
  double omega_s;  // rad/s, width of the regularized law
  SolverMethod method = automatic_method;
  bool unfolds;  // without friction, brake and load the motion repeats: J_x = J_y, a level road, choices automatic
  bool keep_contact;
  double mu_max;                         // the road's coefficient of friction; 0: not checked
  double tolerance;                      // relative, of the whole solution
  double start[WHEEL_MAX_STATES];        // the initial state
  double tilting;                        // rad/s, initial rate of turning about e1 and e2
  double own_time;                       // s, the wheel's own time scale
  double longest_step;                   // s
  double length;                         // m, r_0 + r
  double whole_weight;                   // N, or the force that the time scale stands for without a weight
  double weight;                         // N, scale of the normal force: its part across the road
  double rate_scale, moment_scale;       // rad/s, N m, of margins; powers of two, so that scaling rounds nothing
  double slow_scales[WHEEL_MAX_STATES];  // error of each state that counts as one while the wheel spins slowly
};

Setup setup_of(const Demand& demand);

// The scales at the spin omega_z, rad/s. A fast wheel hardly tilts: the range of theta falls with the square of the
// spin, that of the rates with the spin, and errors are weighed by these ranges.
void scales_at(const Setup& setup, double omega_z, double* out);

// Errors add up over the turns of a fast wheel. Returns the fraction of the usual error that a step may make at the
// spin omega_z, rad/s: below one where the wheel turns very often within its own time scale.
double share_at(const Setup& setup, double omega_z);

}  // namespace wheel
