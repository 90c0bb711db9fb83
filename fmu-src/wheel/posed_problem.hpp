// The initial-value problem y' = f(t, y) that a run poses to the solver, with its error weights and the functions whose
// fall below zero is an event. State: see wheel_equations.h.
#pragma once

#include "wheel.hpp"

namespace wheel {

// (record, with y at the instant reached) => problem of its setup and of what is in force, on which the watched
// functions depend. The record, its owner, stays where it is as long as the problem is in use.
solver::Problem problem_of(Record& record);
// (event, t, y) => what follows for the motion alone: what is in force is changed, nothing is counted or logged.
solver::Consequence follow_on_orbit(void* record, int event, double t, double* y);
// (what is in force) => engine of a motion that is not unfolded: collocation where the direction of a slip settles at
// once, and instead of CVODE in the layer of a regularized law, which would restart at order 1.
solver::Method method_of(const Setup& setup, const InForce& in_force);

}  // namespace wheel
