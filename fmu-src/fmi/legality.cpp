// The call states by name.
#include "legality.hpp"

namespace fmi {

const char* call_state_name(Phase phase) {
  using namespace legality;
  constexpr struct {
    unsigned phases;
    const char* name;
  } states[] = {{instantiated, "instantiated"},
                {initialization, "initialization mode"},
                {step_complete, "step complete"},
                {event_mode, "event mode"},
                {continuous_time, "continuous-time mode"},
                {step_failed, "step failed"},
                {terminated, "terminated"},
                {error, "error"}};
  const auto* state = states;
  while (!(state->phases & bits(phase))) ++state;
  return state->name;
}

}  // namespace fmi
