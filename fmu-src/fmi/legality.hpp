// In which phases of a run a function may be called: the call states of FMI 2.0, section 3.2.3 of the standard for
// model exchange and 4.2.4 for co-simulation.
#pragma once

#include "demand.hpp"
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
  enter_event_mode,
  new_discrete_states,
  enter_continuous_time,
  completed_step,
  set_time,
  set_states,
  get_states,
  count,
};

// Whether the function belongs to this kind of instance, or to both.
bool is_of_kind(Function function, wheel::Kind kind);
bool is_legal(Function function, wheel::Kind kind, wheel::Phase phase);

// The call state that the phase stands for, by the name that the standard uses, for messages.
const char* state_of(wheel::Phase phase);

}  // namespace fmi
