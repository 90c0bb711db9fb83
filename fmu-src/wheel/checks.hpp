// Whether parameters and inputs describe a wheel.
#pragma once

#include "inputs.hpp"

namespace wheel {

// One sentence per fault goes to `tell` (null: nowhere); true if there is none.
bool check_values(const double* parameters, const Inputs& inputs, void* owner,
                  void (*tell)(void* owner, const char* sentence));

}  // namespace wheel
