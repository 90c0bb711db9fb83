// One fuzzed session: two instances, a few saved states, and the calls that the bytes choose.
#pragma once

#include "arguments.hpp"

// What a byte stands for while there is an instance; AGAIN: one more place for an action that is in the list already.
// One call each, with sound or unsound arguments (calls.cpp), or several with a promise (promises.cpp, forge.cpp,
// exchange.cpp).
/* clang-format off */
#define FUZZ_ACTIONS(ONCE, AGAIN) \
  ONCE(step_often) ONCE(do_step) ONCE(pass_values) AGAIN(pass_values) ONCE(start_quickly) \
  ONCE(repeat_step_after_rollback) ONCE(repeat_step_in_new_instance) AGAIN(pass_values) AGAIN(pass_values) \
  ONCE(take_state) ONCE(restore_state) ONCE(set_up_experiment) ONCE(enter_initialization) ONCE(exit_initialization) \
  AGAIN(pass_values) AGAIN(pass_values) ONCE(terminate) ONCE(reset) ONCE(compare_reset_with_new) ONCE(free_state) \
  AGAIN(take_state) AGAIN(restore_state) ONCE(switch_logging) ONCE(exchange) ONCE(forge_state) ONCE(instantiate) \
  ONCE(free_instance)
/* clang-format on */

namespace fuzz {

struct Saved {
  fmi2FMUstate state = nullptr;
  Model model;
};

class Session {
 public:
  Session(const std::uint8_t* data, std::size_t size);  // the first byte: how much is watched
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;
  bool go_on();  // one action; false where there is none left

 private:
  struct Action {
    const char* name;
    void (Session::*act)();
  };
  const Action& action(unsigned choice) const;

#define DECLARE(name) void name();
#define NOTHING(name)
  FUZZ_ACTIONS(DECLARE, NOTHING)
#undef DECLARE
#undef NOTHING

  // A call on the present instance, see checked().
  template <class Function, class... Arguments>
  fmi2Status call(unsigned legal_in, Function* function, Arguments... arguments) {
    return checked(*now_, legal_in, function, arguments...);
  }
  fmi2Status step(Slot& slot, double t, double h);
  double drawn_step();
  template <unsigned legal_in, auto* function>
  void with_drawn();
  template <class... Parameters>
  void with_drawn(unsigned legal_in, fmi2Status (*function)(fmi2Component, Parameters...));

  Bytes in_;
  unsigned actions_left_ = 40;
  Slot slots_[2];
  Slot* now_ = slots_;
  Saved saved_[3];
};

fmi2Component make_instance(fmi2Type kind = fmi2CoSimulation);
// Every formulation, law and method; with and without friction, general inertia, a slope, torque, brake and contact
// kept.
void choose(fmi2Component c, Bytes& in);
// s, a share of the shortest time in which the wheel moves noticeably: short steps keep the fuzzer fast.
double short_step(fmi2Component c);
// Model exchange (exchange.cpp). Euler's step in continuous-time mode, now and then to states that are anywhere;
// whether an event is wanted. The decisions of event mode; true while the model lasts.
bool move_freely(fmi2Component c, double h, Bytes& in);
bool decide(fmi2Component c);
// A state of `origin`, some words changed, is brought to `victim`, which is gone afterwards (forge.cpp).
void bring_forged(fmi2Component origin, fmi2Component victim, fmi2Type kind, Bytes& in);

}  // namespace fuzz
