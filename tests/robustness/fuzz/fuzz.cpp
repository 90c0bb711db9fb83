// The fuzzer's entry. An input that takes too much processor time is a finding, however busy the machine is:
// libFuzzer's own limit counts the time on the clock.
#include <sys/time.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>

#include "session.hpp"

namespace {

// A call may take a million internal steps: two minutes of the multibody form under the sanitizers.
constexpr long most_seconds = 300;

void give_up(int) {
  constexpr char sentence[] = "Expectation broken: an input ends within its processor time.\n";
  (void)!write(STDERR_FILENO, sentence, sizeof sentence - 1);
  std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  std::signal(SIGVTALRM, give_up);
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const itimerval limit = {{}, {most_seconds, 0}}, none = {};
  setitimer(ITIMER_VIRTUAL, &limit, nullptr);
  fuzz::Session session(data, size);
  while (session.go_on()) {
  }
  setitimer(ITIMER_VIRTUAL, &none, nullptr);
  return 0;
}
