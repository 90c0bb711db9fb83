// What the files of this room share: the solver's objects and the place reached in the solution.
#pragma once

#include <cvode/cvode.h>
#include <sundials/sundials_linearsolver.h>
#include <sundials/sundials_matrix.h>
#include <sundials/sundials_nonlinearsolver.h>

#include "integrator.hpp"

namespace integrator {

// A step of CVODE as the control of the next one remembers it.
struct Trend {
  double error, size;  // in units of the tolerance; s
  int order;           // 0: no step yet
};

// The last step, [step_start, known_until], and what stopped it; plain numbers, part of every snapshot.
struct Progress {
  double step_start, known_until, event_time;
  double last_event_value;  // `event` at known_until
  double start_size;        // s, what the last start of high order would have liked; 0: none yet
  Trend trend;
  int pending;  // Outcome: reached, event or ended
  int armed;    // 1: the root function is installed
  Counters counters;
};

struct Integrator::Implementation {
  System system;
  Progress progress;
  SUNContext context;
  void* cvode;
  N_Vector y, scratch;
  SUNNonlinearSolver nonlinear;
  SUNMatrix matrix;
  SUNLinearSolver linear;
  long long last_step;  // the step counter must stay below
  char message[160];
};

// One step, and what stops the solution inside it. False: failed.
bool take_step(Integrator& solution);

// First zero of g on [t_lo, t_hi] of the dense output: t_lo where g(t_lo) = g_lo is negative already; else by sign, or
// by a dip below zero between the ends that a parabola through start, middle and end gives away. False: none.
struct Bracket {
  double t_lo, g_lo, t_hi, g_hi;
};
using Watched = double (*)(void* owner, double t, const double* y);
bool find_first_zero(const Integrator& solution, const System& system, Watched g, const Bracket& step, double* t_zero);

}  // namespace integrator
