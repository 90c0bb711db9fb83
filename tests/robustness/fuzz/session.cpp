// The fuzzer's entry: bytes to a sequence of calls, or to a forged state. The first byte chooses which, and how much is
// watched (see Log).
#include <iterator>

#include "session.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Bytes in(data, size);
  const unsigned first = in.byte();
  if (first & 128)
    fuzz::play_forged(in);
  else
    fuzz::Session(in, first).run();
  return 0;
}

namespace fuzz {

Session::Session(const Bytes& in, unsigned watched) : in_(in) {
  log() = Log();
  log().digests = watched & 1;
  log().calls_back = watched & 2;
  log().on = !(watched & 4);
}

Session::~Session() {
  for (Saved& saved : saved_) {
    Slot any = {make_instance(), {}};
    expect(fmi2FreeFMUstate(any.component, &saved.state) == fmi2OK, "a state outlives its instance");
    fmi2FreeInstance(any.component);
  }
  for (Slot& slot : slots_) fmi2FreeInstance(slot.component);
}

// The action that a byte stands for: each call of the interface while there is an instance, else few.
const Session::Action& Session::action(unsigned choice) const {
  static constexpr Action always[] = {{"instantiate", &Session::instantiate},
                                      {"free_instance", &Session::free_instance},
                                      {"start_quickly", &Session::start_quickly},
                                      {"call_without_instance", &Session::call_without_instance}};
  static constexpr Action with_instance[] = {
      {"step_often", &Session::step_often},
      {"do_step", &Session::do_step},
      {"set_reals", &Session::set_reals},
      {"set_choices", &Session::set_choices},
      {"start_quickly", &Session::start_quickly},
      {"repeat_step_after_rollback", &Session::repeat_step_after_rollback},
      {"repeat_step_in_new_instance", &Session::repeat_step_in_new_instance},
      {"set_input_derivatives", &Session::set_input_derivatives},
      {"get_values", &Session::get_values},
      {"take_state", &Session::take_state},
      {"restore_state", &Session::restore_state},
      {"set_up_experiment", &Session::set_up_experiment},
      {"enter_initialization", &Session::enter_initialization},
      {"exit_initialization", &Session::exit_initialization},
      {"get_output_derivatives", &Session::get_output_derivatives},
      {"directional_derivative", &Session::directional_derivative},
      {"terminate", &Session::terminate},
      {"reset", &Session::reset},
      {"compare_reset_with_new", &Session::compare_reset_with_new},
      {"ask_status", &Session::ask_status},
      {"free_state", &Session::free_state},
      {"serialize", &Session::serialize},
      {"deserialize_damaged", &Session::deserialize_damaged},
      {"switch_logging", &Session::switch_logging},
      {"strings", &Session::strings},
      {"call_model_exchange", &Session::call_model_exchange},
      {"exchange", &Session::exchange},
      {"cancel_step", &Session::cancel_step},
      {"instantiate", &Session::instantiate},
      {"free_instance", &Session::free_instance},
  };
  return now_->component ? with_instance[choice % std::size(with_instance)] : always[choice % std::size(always)];
}

void Session::run() {
  constexpr unsigned most_actions = 40;
  for (unsigned count = 0; count < most_actions && !in_.empty(); ++count) {
    const unsigned choice = in_.byte();
    now_ = slots_ + (choice & 1);
    const Action& chosen = action(choice / 2);
    trace("%u: %s\n", choice & 1, chosen.name);
    (this->*chosen.act)();
  }
}

// From wherever the instance is to step complete, if its parameters allow.
void Session::start_quickly() {
  if (!now_->component) *now_ = {make_instance(), {}};
  if (now_->model.state == instantiated) enter_initialization();
  if (now_->model.state == initialization) exit_initialization();
}

void Session::step_often() {
  const unsigned count = 1 + in_.below(8);
  const double h = usual_step(*now_) * in_.factor();
  for (unsigned k = 0; k < count && now_->model.state == step_complete; ++k) step(*now_, time_of(now_->component), h);
}

}  // namespace fuzz
