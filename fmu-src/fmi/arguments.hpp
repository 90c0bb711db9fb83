// Checks shared by all functions that read or set variables. Each logs what is wrong in one message.
#pragma once

#include <cstddef>

#include "instance.hpp"

namespace fmi {

// False where an array that must have `count` entries is a null pointer.
bool check_arrays(Instance& i, std::size_t count, const void* references, const void* values);

// The start state behind outputs read in initialization mode; Discard while the parameters are faulty.
fmi2Status prepare_reading(Instance& i);

// Calculated variables can be read once there is a state: before a successful start only parameters and inputs can.
bool check_readable(Instance& i, fmi2ValueReference variable);

}  // namespace fmi
