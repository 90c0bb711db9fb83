// What a master may expect of one FMU instance: a model of its call state beside the instance itself, and the checks
// that compare the two after every call. A broken expectation aborts with a message, which the fuzzer records.
#pragma once

#include <string>
#include <vector>

#include "fmi2Functions.h"

namespace fuzz {

// Value references by name, as modelDescription.xml has them.
enum : unsigned {
#define STORED(name, reference, ...) ref_##name = reference,
#define COMPUTED(name, reference, ...) ref_##name = reference,
#include "variables.inc"
};

enum class Type { real, integer, boolean };
enum class Role { parameter, tunable, input, output, local };
// A row of modelDescription.xml; the start value of what can be set.
struct Row {
  unsigned reference;
  Type type;
  Role role;
  double start = 0;
};
inline constexpr Row rows[] = {
#define STORED(name, reference, type, role, start, ...) {reference, Type::type, Role::role, start},
#define COMPUTED(name, reference, type, role) {reference, Type::type, Role::role},
#include "variables.inc"
};
// Null where no variable has the reference.
const Row* row_of(unsigned reference);
// One variable of the role.
unsigned any_of(Role role, unsigned choice);

// Call states of FMI 2.0.5, section 4.2.4.
enum State : unsigned { instantiated, initialization, step_complete, step_failed, terminated, error };
constexpr unsigned I = 1u << instantiated, M = 1u << initialization, C = 1u << step_complete, F = 1u << step_failed,
                   T = 1u << terminated, X = 1u << error;
constexpr unsigned anywhere = I | M | C | F | T | X, settable = I | M | C;
// Beside them: an error may change the instance; the numbers received are finite.
constexpr unsigned may_fail = 1u << 16, finite = 1u << 17;

// What the harness knows of an instance; saved and restored together with the FMU's own state.
struct Model {
  State state = instantiated;
  bool has_stop = false;
  double stop = 0;
};

struct Slot {
  fmi2Component component = nullptr;
  Model model;
};

// Log of a session's instances: how many messages came, and whether the logger calls back into the FMU.
struct Log {
  unsigned messages = 0;
  bool on = true, calls_back = false;
  fmi2Component caller = nullptr;  // while one of its calls is under way
  bool digests = false;            // serialize before and after every call that must change nothing
};
Log& log();  // of the session that is played

// With WHEEL_FUZZ_TRACE in the environment: a line on stderr, so that an artifact can be read as a sequence of calls.
[[gnu::format(printf, 1, 2)]] void trace(const char* format, ...);

[[noreturn]] void fail(const char* expectation);
inline void expect(bool truth, const char* expectation) {
  if (!truth) fail(expectation);
}

fmi2CallbackFunctions callbacks();

// The serialized state: equal bytes mean that nothing observable differs.
using Digest = std::vector<fmi2Byte>;
Digest digest(fmi2Component component);

// Bits of every variable; in a state where reading is not allowed: empty.
std::vector<double> readings(const Slot& slot);
bool same_bits(const std::vector<double>& a, const std::vector<double>& b);

double time_of(fmi2Component component);
void check_finite(const std::vector<double>& values);

// One call: illegal ones must fail, say why and change nothing; so must legal ones that report an error, unless
// legal_in has `may_fail`: doStep and the end of initialization lead to the error state.
template <class Function, class... Arguments>
fmi2Status checked(Slot& slot, unsigned legal_in, Function* function, Arguments... arguments) {
  const bool legal = legal_in & (1u << slot.model.state);
  const unsigned said = log().messages;
  const Digest before = log().digests ? digest(slot.component) : Digest();
  log().caller = slot.component;
  const fmi2Status status = function(slot.component, arguments...);
  log().caller = nullptr;
  expect(status >= fmi2OK && status <= fmi2Error, "the status is OK, Warning, Discard or Error");
  if (!legal) expect(status == fmi2Error, "an illegal call returns fmi2Error");
  if (status != fmi2Error) return status;
  if (log().on) expect(log().messages > said, "an error is explained in the log");
  const bool changes_nothing = !legal || !(legal_in & may_fail);
  if (log().digests && changes_nothing) expect(digest(slot.component) == before, "a refused call changes nothing");
  return status;
}

}  // namespace fuzz
