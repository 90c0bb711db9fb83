// The wheel in motion as an initial-value problem for the solver: y' = f(t, y), its error weights, and the functions
// whose fall below zero is an event. Reduced or multibody state, see wheel_equations.h.
#pragma once

#include "event.hpp"
#include "law.hpp"
#include "solver.hpp"

namespace wheel {

// Angle from lying flat, rad, below which the wheel counts as flat: at the paper's scale about 1e-8 s before theta = 0.
inline constexpr double flat_angle = 1e-7;

// rad, from the side that is nearer.
double angle_from_flat(double theta);

// What the functions of the problem need besides time and state. They only read it.
struct Owner {
  const Setup& setup;
  InForce& in_force;
};

// What is watched goes with what is in force.
solver::Problem problem_of(Owner& owner);

// Zero where the ground begins to pull, or to press while it pulls, over the weight. What is below zero only by
// rounding does not count.
double contact_margin(const Owner& owner, double t, const double* y);

}  // namespace wheel
