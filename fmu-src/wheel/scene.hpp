// The choices of a scene: formulation, friction law, method, error scales. Pure functions of parameters and state.
#pragma once

#include "integrator.hpp"
#include "variables.hpp"
#include "wheel_equations.h"

namespace wheel {

// sin(theta) below which the wheel counts as lying flat: at the paper's scale some 1e-8 s before theta = 0.
inline constexpr double flat_sine = 1e-7;

WheelParameters parameters_from(const double* stored);
WheelMotion initial_motion(const double* stored);
const WheelFormulation& choose_formulation(const double* stored);
integrator::Method choose_method(const double* stored);

// The friction law at state y under the scene's load; at omega_z = 0 after Filippov: held where the moment that holds
// it is within s N, else slipping against that moment. The state is expected to have omega_z exactly 0 there.
WheelFriction friction_at(const double* stored, const WheelFormulation& formulation, const WheelScene& scene,
                          const double* y);

// s N - |tau| of a held wheel, N m, with the rounding of tau on the side of holding.
double holding_margin(const WheelParameters& wheel, const WheelDynamics& held);

// Only the exact law switches.
bool watches_event(const WheelScene& scene);

// Error of each state that counts as one: angles 1 rad, lengths r_0 + r, rates that of the wheel's own time scale or
// the initial one. A fast spin does not loosen the others: N answers to each of them times the spin.
void error_scales(const WheelParameters& wheel, const WheelFormulation& formulation, const double* y, double* scales);

// sqrt((r_0 + r) / g), s; without weight the time of a turn at the initial rate.
double time_scale(const WheelParameters& wheel, const WheelKinematics& start);

// Internal steps that one call over h may take, s, from a spin omega_z: many times what a sane motion needs, and about
// a second of computing for one that absurd loads set spinning.
long long most_steps(const WheelParameters& wheel, double omega_z, double h);

}  // namespace wheel
