// The choices of a scene: formulation, friction law, method, error scales. Pure functions of parameters and state.
#pragma once

#include "solver.hpp"
#include "wheel_equations.h"

namespace wheel {

// `stored` holds the parameters in the order of the variables.
WheelParameters parameters_from(const double* stored);
WheelMotion initial_motion(const double* stored);
const WheelFormulation& choose_formulation(const double* stored);

// Which method solves what follows. `jumps`: inputs or tunable parameters change during the run, and the motion is not
// smooth where they do. `scene` has the law of friction in force.
solver::Method choose_method(const double* stored, const WheelScene& scene, bool jumps);

// Whether the motion repeats and can be unfolded from half a nutation: reduced form with J_x = J_y, no friction, no
// brake, no load, a level road, formulation and method left to the program.
bool is_unfoldable(const double* stored, const WheelScene& scene, bool loaded);

// The friction law at state y under the scene's load; `braked`: the brake is in use. At omega_z = 0 after Filippov:
// held where the moment that holds it is within s N + M_brake, else rolling against that moment.
WheelFriction friction_at(const double* stored, const WheelFormulation& formulation, const WheelScene& scene,
                          bool braked, double weight, const double* y);

// s N + M_brake - |tau| of a held wheel, N m; where rounding alone decides, the wheel stays held. weight: N, the scale
// of the normal force.
double holding_margin(const WheelScene& scene, const WheelDynamics& held, double weight);

// Only the exact law has transitions.
bool has_transitions(const WheelScene& scene);

// How errors of the states are weighed.
struct ErrorScales {
  double slow[WHEEL_MAX_STATES];  // error of each state that counts as one while the wheel spins slowly
  double own_rate, tilting;       // rad/s: of the wheel's own time scale; initial rate of turning about e1 and e2
};

// The scale of angles is 1 rad, of lengths r_0 + r, of rates the inverse of the wheel's own time scale or the initial
// tilting, whichever is larger.
ErrorScales error_scales(const WheelParameters& wheel, const WheelFormulation& formulation, const double* y);

// The scales at the spin omega_z, rad/s. A fast wheel hardly tilts: the range of theta falls with the square of the
// spin, that of the rates with the spin, and errors are weighed by these ranges.
void scales_at(const ErrorScales& scales, const WheelFormulation& formulation, double omega_z, double* out);

// Errors add up over the turns of a fast wheel. Returns the fraction of the usual error that a step may make at the
// spin omega_z, rad/s: below one where the wheel turns very often within its own time scale.
double share_at(const ErrorScales& scales, double omega_z);

// sqrt((r_0 + r) / g), s, g the whole of gravity; without a weight that matters the time of a turn at the initial rate.
double time_scale(const WheelParameters& wheel, const WheelKinematics& start);

// N, scale of the normal force: the weight's part across the road, or what its time scale stands for without a weight.
double force_scale(const WheelParameters& wheel, double own_time);

}  // namespace wheel
