// What acts on the wheel from an instant on: road, inputs, and the law of friction after Filippov. Pure functions of
// setup, load and state.
#pragma once

#include "run.hpp"

namespace wheel {

// What acts from t on: road and inputs. A mu_max set below mu_slide counts for both.
void let_act(const Setup& setup, const Road& road, double t, const Polynomials& inputs, InForce& in_force);

// The law apart from layers; `braked`: the brake is in use.
WheelFriction friction_at(const Setup& setup, const WheelScene& scene, bool braked, const double* y);

// Decides the law of friction from t and y on. At omega_z = 0 after Filippov: held where the moment that holds the
// wheel is within s N + M_brake, else rolling against that moment. `released`: friction and brake can no longer hold
// it. A stiff regularized law is decided by the place of omega_z in its layer.
void decide_law(const Setup& setup, double t, const double* y, InForce& in_force, bool released = false);

// Whether two laws differ in kind, or in the side to which the wheel spins.
inline bool differ(const WheelFriction& a, const WheelFriction& b) { return a.kind != b.kind || a.sigma != b.sigma; }

// s N + M_brake - |tau| of a held wheel, N m; where rounding alone decides, the wheel stays held.
double holding_reserve(const Setup& setup, const WheelScene& scene, const double* y);

// rad/s, half the width of the layer of a stiff regularized law: outside of it the law is the exact one to the last
// digit.
inline double layer_edge(const Setup& setup) { return 20 * setup.omega_s; }

// Below zero where a regularized law is so steep that it is solved by its layer and, around it, by the exact law. Once
// solved so, it stays so until an input changes.
bool can_stiffen(const Setup& setup, const InForce& in_force);
double softness_of(const Setup& setup, const WheelScene& scene, const double* y);

}  // namespace wheel
