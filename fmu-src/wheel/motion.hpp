// The wheel in motion as an initial-value problem for the solver: y' = f(t, y), its error weights, and the functions
// whose fall below zero is an event. Reduced or multibody state, see wheel_equations.h.
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

// What can happen at an instant that is not known beforehand.
enum class Event : int {
  none,
  spin_changes,     // omega_z reaches zero, or friction and brake can no longer hold it there
  contact_changes,  // with keep_contact: the ground begins to pull or to press
  lifted_off,
  fell_flat
};

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

// Scales of errors, forces and steps, from the parameters and the initial state.
void set_scales(Motion& motion, const double* y);

inline bool pulls(const Motion& motion) { return motion.scene.ground == WHEEL_GROUND_PULLS; }

// The ground begins to pull, or to press.
void change_contact(Motion& motion);

// The problem refers to the motion and changes nothing of it but the load of its scene. What is watched goes with the
// law in force.
solver::Problem problem_of(Motion& motion);

}  // namespace wheel
