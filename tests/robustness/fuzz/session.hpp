// One fuzzed session: two instances, a few saved states, and the calls that the bytes choose.
#pragma once

#include "choices.hpp"
#include "oracle.hpp"

// What a byte stands for while there is an instance, in the order of the corpus; AGAIN: one more place for
// an action that is in the list already. One call each, with sound or unsound arguments (calls.cpp, values.cpp,
// states.cpp, exchange.cpp), or several (session.cpp, states.cpp).
/* clang-format off */
#define FUZZ_ACTIONS(ONCE, AGAIN) \
  ONCE(step_often) ONCE(do_step) ONCE(set_reals) ONCE(set_choices) ONCE(start_quickly) \
  ONCE(repeat_step_after_rollback) ONCE(repeat_step_in_new_instance) ONCE(set_input_derivatives) ONCE(get_values) \
  ONCE(take_state) ONCE(restore_state) ONCE(set_up_experiment) ONCE(enter_initialization) ONCE(exit_initialization) \
  ONCE(get_output_derivatives) ONCE(directional_derivative) ONCE(terminate) ONCE(reset) ONCE(compare_reset_with_new) \
  ONCE(ask_status) ONCE(free_state) ONCE(serialize) ONCE(deserialize_damaged) ONCE(switch_logging) ONCE(strings) \
  AGAIN(enter_initialization) ONCE(exchange) AGAIN(enter_initialization) ONCE(instantiate) ONCE(free_instance)
/* clang-format on */

namespace fuzz {

struct Saved {
  fmi2FMUstate state = nullptr;
  Model model;
};

class Session {
 public:
  Session(const Bytes& in, unsigned watched, bool shared = false);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;
  bool go_on();  // one action; false where there is none left
  const Log& seen() const { return log_; }

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

  fmi2Status step(Slot& slot, double t, double h);
  double usual_step(const Slot& slot);
  double value_for(unsigned reference);
  unsigned reference();

  Bytes in_;
  Log log_;
  unsigned actions_left_ = 40;
  Slot slots_[2];
  Slot* now_ = slots_;
  Saved saved_[3];
  fmi2Component freed_ = nullptr;
};

fmi2Component make_instance(fmi2Type kind = fmi2CoSimulation);
// s, a share of the shortest time in which the wheel moves noticeably: short steps keep the fuzzer fast.
double short_step(fmi2Component c);
void play_forged(Bytes& in, fmi2Type kind);             // forge.cpp
void play(const std::uint8_t* data, std::size_t size);  // all bytes of an input

}  // namespace fuzz
