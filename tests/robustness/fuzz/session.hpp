// One fuzzed session: two instances, a few saved states, and the calls that the bytes choose.
#pragma once

#include "choices.hpp"
#include "oracle.hpp"

namespace fuzz {

struct Saved {
  fmi2FMUstate state = nullptr;
  Model model;
};

class Session {
 public:
  Session(const Bytes& in, unsigned watched);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;
  void run();

 private:
  struct Action {
    const char* name;
    void (Session::*act)();
  };
  const Action& action(unsigned choice) const;

  // calls.cpp: one call each, with sound or unsound arguments.
  void instantiate();
  void free_instance();
  void set_up_experiment();
  void enter_initialization();
  void exit_initialization();
  void terminate();
  void reset();
  void do_step();
  void ask_status();
  void switch_logging();
  void call_model_exchange();
  void cancel_step();
  // values.cpp
  void set_reals();
  void set_choices();
  void get_values();
  void strings();
  void set_input_derivatives();
  void get_output_derivatives();
  void directional_derivative();
  // states.cpp
  void take_state();
  void restore_state();
  void free_state();
  void serialize();
  void without_arrays(const Saved& saved);
  void deserialize_damaged();
  void repeat_step_after_rollback();
  void repeat_step_in_new_instance();
  void compare_reset_with_new();
  void exchange();               // exchange.cpp
  void call_without_instance();  // absent.cpp

  void start_quickly();
  void step_often();
  fmi2Status step(Slot& slot, double t, double h);
  double usual_step(const Slot& slot);
  double value_for(unsigned reference);
  unsigned reference();

  Bytes in_;
  Slot slots_[2];
  Slot* now_ = slots_;
  Saved saved_[3];
  fmi2Component freed_ = nullptr;
};

fmi2Component make_instance();
void play_forged(Bytes& in);  // forge.cpp

}  // namespace fuzz
