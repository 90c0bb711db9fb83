// The wheel in motion as an initial-value problem for the solver: y' = f(t, y), its error weights, the transition of
// the rolling friction as event, the limits of the model as boundary. Reduced or multibody state, see
// wheel_equations.h.
#pragma once

#include "inputs.hpp"
#include "scene.hpp"
#include "solver.hpp"
#include "wheel_equations.h"

namespace wheel {

// Angle from lying flat, rad, below which the wheel counts as flat: at the paper's scale about 1e-8 s before theta = 0.
inline constexpr double flat_angle = 1e-7;

// rad, from the side that is nearer.
double angle_from_flat(double theta);

// What the right-hand side and the watched functions need besides time and state.
struct Motion {
  const WheelFormulation* formulation = nullptr;
  WheelScene scene = {};  // the law in force; its load follows the inputs
  Inputs inputs;
  double tolerance = 0;  // relative, of the whole solution
  ErrorScales scales = {};
  double weight = 0;        // N, scale of the normal force
  double longest_step = 0;  // s
  bool keep_contact = false;
};

// The problem refers to the motion and changes nothing of it but the load of its scene.
solver::Problem problem_of(Motion& motion);

// Normal force N over the weight at state y; for solver::Solver::first_fall.
double normal_force(void* motion, double t, const double* y);

}  // namespace wheel
