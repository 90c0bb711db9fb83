// The start of high order: one Runge-Kutta step, and the history CVODE goes on from.
#pragma once

#include "cvode_impl.h"
#include "implementation.hpp"

namespace integrator {

// Steps from (t, y) = (progress.known_until, self.y) and hands CVODE the step's polynomial as its history. False, with
// time and state as they were, where the right-hand side does not allow it: CVODE then starts by itself, at order one.
bool start_high(Integrator::Implementation& self);

// Whether CVODE has a polynomial to go on with: from its own steps or from a start of high order.
bool has_history(const CVodeMemRec& m);

// Shortens the first step after a start of high order, and its history with it, so that it ends at the stop time; CVODE
// by itself would shorten the step alone. Without a history it gives the step where so few roundings of t are left that
// CVODE refuses to guess one.
void fit_before_stop(CVodeMemRec& m);

}  // namespace integrator
