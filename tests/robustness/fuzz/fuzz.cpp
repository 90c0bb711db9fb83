// The fuzzer's entry: bytes to a sequence of calls.
#include <iterator>

#include "session.hpp"

namespace fuzz {

Session::Session(const std::uint8_t* data, std::size_t size) : in_(data, size) {
  const unsigned watched = in_.byte();
  log() = {};
  log().digests = watched & 1;
  log().calls_back = watched & 2;
  log().on = !(watched & 4);
}

Session::~Session() {
  for (Saved& saved : saved_) {
    const fmi2Component any = make_instance();
    expect(fmi2FreeFMUstate(any, &saved.state) == fmi2OK, "a state outlives its instance");
    fmi2FreeInstance(any);
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
  --actions_left_;
  const unsigned choice = in_.byte();
  now_ = slots_ + (choice & 1);
  const Action& chosen = action(choice / 2);
  trace("%u: %s\n", choice & 1, chosen.name);
  (this->*chosen.act)();
  return true;
}

}  // namespace fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Session session(data, size);
  while (session.go_on()) {
  }
  return 0;
}
