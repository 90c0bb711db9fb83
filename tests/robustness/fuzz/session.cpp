// Bytes to a sequence of calls, or to a forged state. The first byte chooses which, of what kind, and how much is
// watched (see Log).
#include "session.hpp"

#include <iterator>

namespace fuzz {

void play(const std::uint8_t* data, std::size_t size) {
  Bytes in(data, size);
  const unsigned first = in.byte();
  if (first & 128) {
    play_forged(in, first & 64 ? fmi2ModelExchange : fmi2CoSimulation);
  } else {
    Session session(in, first);
    while (session.go_on()) {
    }
  }
}

Session::Session(const Bytes& in, unsigned watched, bool shared) : in_(in) {
  log_.digests = watched & 1;
  log_.calls_back = watched & 2;
  log_.on = !(watched & 4);
  log_.shared = shared;
}

Session::~Session() {
  use(log_);
  for (Saved& saved : saved_) {
    Slot any = {make_instance(), {}};
    expect(fmi2FreeFMUstate(any.component, &saved.state) == fmi2OK, "a state outlives its instance");
    fmi2FreeInstance(any.component);
  }
  for (Slot& slot : slots_) fmi2FreeInstance(slot.component);
}

// The action that a byte stands for; without an instance few have a meaning.
const Session::Action& Session::action(unsigned choice) const {
#define ROW(name) {#name, &Session::name},
  static constexpr Action with_instance[] = {FUZZ_ACTIONS(ROW, ROW)};
  static constexpr Action always[] = {ROW(instantiate) ROW(free_instance) ROW(start_quickly) ROW(start_quickly)};
#undef ROW
  return now_->component ? with_instance[choice % std::size(with_instance)] : always[choice % std::size(always)];
}

bool Session::go_on() {
  if (in_.empty() || actions_left_ == 0) return false;
  use(log_);
  --actions_left_;
  const unsigned choice = in_.byte();
  now_ = slots_ + (choice & 1);
  const Action& chosen = action(choice / 2);
  trace("%u: %s\n", choice & 1, chosen.name);
  (this->*chosen.act)();
  return true;
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
