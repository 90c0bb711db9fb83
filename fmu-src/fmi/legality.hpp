// In which phases of a run a function may be called: the call states of FMI 2.0, section 3.2.3 of the standard for
// model exchange and 4.2.4 for co-simulation.
#pragma once

#include "run.hpp"

namespace fmi {

using wheel::Kind, wheel::Phase;

// One bit for each of some enumerators.
template <class... Each>
constexpr unsigned bits(Each... each) {
  return ((1u << static_cast<unsigned>(each)) | ...);
}

// Where a function is legal: one bit for each phase, and one for each kind of instance.
struct Rule {
  unsigned phases, kinds;

  constexpr bool is_for(Kind kind) const { return (kinds & bits(kind)) != 0; }
  constexpr bool allows(Kind kind, Phase phase) const { return is_for(kind) && (phases & bits(phase)) != 0; }
};

// One rule for each function, or for several that are legal together. Whether a variable may be set depends on the
// variable too: see values.cpp.
namespace legality {

inline constexpr unsigned instantiated = bits(Phase::created),
                          initialization = bits(Phase::initializing, Phase::faulty, Phase::initial),
                          step_complete = bits(Phase::at_start, Phase::stepping, Phase::unfolded),
                          event_mode = bits(Phase::event_mode), continuous_time = bits(Phase::continuous_time),
                          step_failed = bits(Phase::ended), terminated = bits(Phase::closed),
                          error = bits(Phase::broken, Phase::without_start);
inline constexpr unsigned running = step_complete | event_mode | continuous_time,
                          stopped = step_failed | terminated | error,
                          any_state = instantiated | initialization | running | stopped;
// Each phase belongs to one call state.
static_assert(instantiated + initialization + step_complete + event_mode + continuous_time + step_failed + terminated +
                      error ==
                  any_state &&
              any_state + 1 == bits(wheel::phase_count));

inline constexpr unsigned co_simulation = bits(Kind::co_simulation), model_exchange = bits(Kind::model_exchange),
                          both = co_simulation | model_exchange;

inline constexpr Rule always = {any_state, both};  // logging, reset, FMU states
inline constexpr Rule before_initialization = {instantiated, both};
inline constexpr Rule exit_initialization = {initialization, both};
inline constexpr Rule terminate = {running | step_failed, both};
inline constexpr Rule get_values = {initialization | running | stopped, both};
inline constexpr Rule set_values = {instantiated | initialization | running, both};
inline constexpr Rule set_input_derivatives = {instantiated | initialization | step_complete, co_simulation};
inline constexpr Rule get_output_derivatives = {step_complete | stopped, co_simulation};
inline constexpr Rule do_step = {step_complete, co_simulation};
inline constexpr Rule cancel_step = {0, co_simulation};
inline constexpr Rule get_status = {step_complete | step_failed | terminated, co_simulation};
inline constexpr Rule while_integrating = {continuous_time, model_exchange};  // states, end of a step, event mode
inline constexpr Rule new_discrete_states = {event_mode, model_exchange};
inline constexpr Rule enter_continuous_time = {event_mode | step_failed, model_exchange};
inline constexpr Rule set_time = {event_mode | continuous_time, model_exchange};
inline constexpr Rule get_states = {initialization | event_mode | continuous_time | stopped, model_exchange};

}  // namespace legality
}  // namespace fmi
