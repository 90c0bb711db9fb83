// The call states of an FMI 2.0 co-simulation slave, and in which of them a function may be called: section 4.2.4 of
// the standard.
#pragma once

namespace fmi {

enum class State : unsigned char { instantiated, initialization, step_complete, step_failed, terminated, error };

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

bool is_legal(Function function, State state);

// The name that the standard uses, for messages.
const char* name_of(State state);

}  // namespace fmi
