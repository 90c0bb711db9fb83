// What is in force from an instant on: the law of friction, the method that solves what follows, and whether the
// motion can be unfolded. Pure functions of setup, load and state.
#pragma once

#include "run.hpp"
#include "setup.hpp"

namespace wheel {

// Puts in force, at the state y, what is asked for: `s`, inputs from t on, and the law of friction that goes with them.
void put_in_force(const Setup& setup, const Demand& demand, double t, const double* y, InForce& in_force);

// The friction law at state y under the scene's load; `braked`: the brake is in use. At omega_z = 0 after Filippov:
// held where the moment that holds it is within s N + M_brake, else rolling against that moment.
WheelFriction friction_at(const Setup& setup, const WheelScene& scene, bool braked, const double* y);

// The law of a held wheel that is let go.
WheelFriction released(const Setup& setup, const WheelScene& held, const double* y);

// Whether two laws differ in kind, or in the side to which the wheel spins.
inline bool differ(const WheelFriction& a, const WheelFriction& b) { return a.kind != b.kind || a.sigma != b.sigma; }

// s N + M_brake - |tau| of a held wheel, N m; where rounding alone decides, the wheel stays held.
double holding_margin(const Setup& setup, const WheelScene& scene, const double* y);

// rad/s, half the width of the layer of a stiff regularized law: outside of it the law is the exact one to the last
// digit.
inline double layer_edge(const Setup& setup) { return 20 * setup.omega_s; }

// Below zero where a regularized law is so steep that it is solved by its layer and, around it, by the exact law. Once
// solved so, it stays so until an input changes.
double layer_margin(const Setup& setup, const WheelScene& scene, const double* y);

inline bool may_need_layer(const Setup& setup, const InForce& now) {
  const bool asked = setup.method == automatic_method && setup.formulation != &wheel_euler;
  return asked && now.layer == Layer::none && now.scene.friction.kind == WHEEL_REGULARIZED;
}

// Where omega_z stands in the layer at t and y, and the law of friction there.
void enter_layer(const Setup& setup, InForce& in_force, double t, const double* y);

// What solves the motion that is not unfolded.
solver::Method method_of(const Setup& setup, const InForce& in_force);

// Whether the motion repeats and can be unfolded from half a nutation.
bool is_unfoldable(const Setup& setup, const InForce& in_force);

}  // namespace wheel
