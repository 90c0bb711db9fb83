// Jumps of the rates at which a wheel carrier turns the wheel: an input that is held begins with one.
#pragma once

#include "run.hpp"

namespace wheel {

// From here on psi and theta turn at these rates, rad/s. A jump is the limit of ever shorter, steeper ramps of both
// rates: what holds the wheel to the road acts whatever it takes, friction of the ground by the normal force of the
// ramp, and a brake, whose moment is finite, not at all. So a course that is cut into jumps comes near to the whole.
// Writes y.
void turn_carrier(const Setup& setup, const WheelScene& scene, double psi_dot, double theta_dot, double* y);

}  // namespace wheel
