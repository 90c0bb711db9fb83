// In which phases of a run a function may be called: the call states of an FMI 2.0 co-simulation slave, section 4.2.4
// of the standard.
#pragma once

#include "phase.hpp"

namespace fmi {

enum class Function : unsigned char {
  set_debug_logging,
  setup_experiment,
  enter_initialization,
  exit_initialization,
  terminate,
  reset,
  get_values,
  set_values,
  fmu_state,
  set_fmu_state,
  free_fmu_state,
  directional_derivative,
  set_input_derivatives,
  get_output_derivatives,
  do_step,
  cancel_step,
  get_status,
  model_exchange,
  count,
};

bool is_legal(Function function, wheel::Phase phase);

// The call state that the phase stands for, by the name that the standard uses, for messages.
const char* state_of(wheel::Phase phase);

}  // namespace fmi
