// Problems with closed forms for the solver alone; no wheel, no frame.
#pragma once

#include <functional>
#include <vector>

#include "solver.hpp"

// A problem given by functions of (t, y). Weights: 1 / (share tolerance (1 + |y|)).
struct Case {
  int states = 0;
  double tolerance = 1e-8, longest_step = 1, near = 0.1, t = 0;
  std::vector<double> y;
  std::function<void(double, const double*, double*)> rates;
  std::function<double(double, const double*)> each_step, by_margin;  // watched: events 1 and 2
  std::vector<double> extremes;

  solver::Problem problem();
};

Case harmonic();                       // y = (cos t, -sin t) from t = 0
Case growth(double rate);              // y' = rate y from 1
Case van_der_pol(double mu);           // from (2, 0)
Case bouncing(double height);          // (height, speed) under g = 9.81; watched: the height
Case clock_only(double longest_step);  // y' = 1: what is watched is a function of time

// Steps until t is known or something else than a step happens.
solver::Outcome run_to(solver::Solver& solver, double t, long long most_steps = 1000000);
