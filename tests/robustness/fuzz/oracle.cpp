// The oracles: log messages, serialized state, finite readings.
#include "oracle.hpp"

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace fuzz {
namespace {

// A message is a printf format to the master, and # opens a reference to a variable: both are doubled.
void check_message(const char* text) {
  const std::size_t length = std::strlen(text);
  expect(length > 0 && length < 1000, "a message has 1 to 999 bytes");
  expect(text[length - 1] != '\n', "a message does not end in a new line");
  for (const char special : {'%', '#'})
    for (const char* at = std::strchr(text, special); at; at = std::strchr(at + 2, special))
      expect(at[1] == special, "percent and number signs are doubled");
}

bool is_category(const char* category) {
  for (const char* known : {"logEvents", "logStatusWarning", "logStatusDiscard", "logStatusError"})
    if (!std::strcmp(category, known)) return true;
  return false;
}

void call_back(fmi2Component c) {
  const fmi2ValueReference reference = ref_E;
  double value = 0;
  expect(fmi2GetReal(c, &reference, 1, &value) == fmi2Error, "the logger cannot call into the FMU");
  expect(fmi2DoStep(c, 0, 1, fmi2True) == fmi2Error, "the logger cannot step the FMU");
  expect(fmi2Reset(c) == fmi2Error, "the logger cannot reset the FMU");
  fmi2FreeInstance(c);
}

void receive(fmi2ComponentEnvironment environment, fmi2String name, fmi2Status, fmi2String category, fmi2String message,
             ...) {
  Log& log = *static_cast<Log*>(environment);
  ++log.messages;
  trace("    %s\n", message);
  expect(name && category && message, "the logger gets no null pointer");
  expect(is_category(category), "the category is one of modelDescription.xml");
  check_message(message);
  if (log.calls_back && log.caller) call_back(log.caller);
}

}  // namespace

const Row* row_of(unsigned reference) {
  const Row* const row = std::ranges::find(rows, reference, &Row::reference);
  return row == std::end(rows) ? nullptr : row;
}

unsigned any_of(Role role, unsigned choice) {
  const Row* const first = std::ranges::find(rows, role, &Row::role);  // those of a role stand together
  return first[choice % static_cast<unsigned>(std::ranges::count(rows, role, &Row::role))].reference;
}

Log& log() {
  static Log of_this_session;
  return of_this_session;
}

void trace(const char* format, ...) {
  static const bool wanted = std::getenv("WHEEL_FUZZ_TRACE");
  if (!wanted) return;
  std::va_list arguments;
  va_start(arguments, format);
  std::vfprintf(stderr, format, arguments);
  va_end(arguments);
}

void fail(const char* expectation) {
  std::fprintf(stderr, "Expectation broken: %s.\n", expectation);
  std::abort();
}

fmi2CallbackFunctions callbacks() { return {receive, std::calloc, std::free, nullptr, &log()}; }

Digest digest(fmi2Component component) {
  fmi2FMUstate state = nullptr;
  std::size_t size = 0;
  expect(fmi2GetFMUstate(component, &state) == fmi2OK, "a state can always be taken");
  expect(fmi2SerializedFMUstateSize(component, state, &size) == fmi2OK, "a state has a size");
  Digest bytes(size);
  expect(fmi2SerializeFMUstate(component, state, bytes.data(), size) == fmi2OK, "a state can be serialized");
  expect(fmi2FreeFMUstate(component, &state) == fmi2OK && !state, "a state can be freed");
  return bytes;
}

std::vector<double> readings(const Slot& slot) {
  std::vector<double> values;
  for (const auto& [reference, type, role, start] : rows) {
    fmi2Status status = fmi2OK;
    double real = 0;
    int whole = 0;
    if (type == Type::boolean)
      status = fmi2GetBoolean(slot.component, &reference, 1, &whole);
    else if (type == Type::integer)
      status = fmi2GetInteger(slot.component, &reference, 1, &whole);
    else
      status = fmi2GetReal(slot.component, &reference, 1, &real);
    expect(status == fmi2OK, "every variable can be read after the start");
    values.push_back(real + whole);
  }
  return values;
}

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && !std::memcmp(a.data(), b.data(), a.size() * sizeof(double));
}

double time_of(fmi2Component component) {
  double t = 0;
  expect(fmi2GetRealStatus(component, fmi2LastSuccessfulTime, &t) == fmi2OK, "the last successful time is known");
  return t;
}

void check_finite(const std::vector<double>& values) {
  for (std::size_t k = 0; k < values.size(); ++k)
    expect(std::isfinite(values[k]) || rows[k].role <= Role::input || rows[k].reference == ref_mu_required,
           "what can be read is finite");
}

}  // namespace fuzz
