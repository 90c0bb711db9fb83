// Instances: creation, logging, the checks that many functions share.
#include "instance.hpp"

#include <cstdlib>
#include <cstring>
#include <new>

#include "logbook.hpp"
#include "setting.hpp"

namespace fmi {

using wheel::Topic;

namespace {

// A message is a format to the master, and '#' opens a variable name: both characters are doubled.
void escape(const char* text, char* out, std::size_t size) {
  std::size_t length = 0;
  for (; *text && length + 2 < size; ++text) {
    if (*text == '%' || *text == '#') out[length++] = *text;
    out[length++] = *text;
  }
  out[length] = 0;
}

// The call state that a phase stands for, by the name that the standard uses.
const char* name_of_state(Phase phase) {
  using namespace legality;
  constexpr struct {
    unsigned phases;
    const char* name;
  } states[] = {{instantiated, "instantiated"},
                {initialization, "initialization mode"},
                {step_complete, "step complete"},
                {event_mode, "event mode"},
                {continuous_time, "continuous-time mode"},
                {step_failed, "step failed"},
                {terminated, "terminated"},
                {error, "error"}};
  const auto* state = states;
  while (!(state->phases & bits(phase))) ++state;
  return state->name;
}

}  // namespace

Instance::Instance(const fmi2CallbackFunctions* callbacks, wheel::Kind kind)
    : Handle{.mark = kind_mark}, callbacks_(callbacks ? *callbacks : fmi2CallbackFunctions{}), wheel_(*this, kind) {}

void Instance::take(Topic topic, const char* message) const {
  char escaped[2 * longest];
  escape(message, escaped, sizeof escaped);
  const auto [category, status, call] = category_of(topic);
  arithmetic.give_back();
  callbacks_.logger(callbacks_.componentEnvironment, name_, status, category, escaped);
  arithmetic.take();
}

Instance* Instance::create(const char* name, const fmi2CallbackFunctions* callbacks, bool logging, wheel::Kind kind) {
  const auto name_size = std::strlen(name) + 1;
  void* memory = std::malloc(sizeof(Instance) + name_size);
  if (!memory) return nullptr;
  auto* instance = ::new (memory) Instance(callbacks, kind);
  instance->name_ = static_cast<char*>(std::memcpy(static_cast<char*>(memory) + sizeof(Instance), name, name_size));
  const unsigned all = 0xf, quiet = all & ~bits(Topic::event);
  instance->logged_topics = logging ? all : quiet;
  return instance;
}

// After the end of a run the message names the end, which helps a user more than the call state.
fmi2Status Instance::refuse(const Rule& rule) {
  const bool slave = wheel.demand.kind == wheel::Kind::co_simulation;
  if (!rule.is_for(wheel.demand.kind))
    return log(Topic::error, "%s belongs to %s; this instance was made for %s.",
               slave ? "model exchange" : "co-simulation", slave ? "co-simulation" : "model exchange");
  if (wheel.run.phase == Phase::ended)
    return log(Topic::error, "%s: the wheel %s at t = %s s. Restore a state or reset.",
               wheel::ending_of(wheel.run.in_force, wheel.run.ended_by).text, wheel.time());
  return log(Topic::error, "%s is not allowed in the state \"%s\".", name_of_state(wheel.run.phase));
}

fmi2Status Instance::prepare_reading(const fmi2ValueReference variables[], std::size_t count) {
  const wheel::Listed listed = {variables};
  std::size_t computed = 0;
  while (computed < count && listed[computed] < wheel::stored_count) ++computed;
  if (computed == count || has_state(wheel.run.phase)) return fmi2OK;
  if (!wheel::prepare_once(change())) return fmi2Discard;
  const bool readable = has_state(wheel.run.phase);
  const char* const name = wheel::row_of(listed[computed]).name;
  return check(readable, "%s: \"%s\" has no value before a successful initialization.", name) ? fmi2OK : fmi2Error;
}

double Instance::value_of(unsigned variable) {
  if (variable < wheel::stored_count) return wheel.demand.value(variable);
  if (!reading_) {
    reading_.emplace(wheel);
    wheel::warn_of_jam(wheel);
  }
  return wheel::row_of(variable).read(*reading_);
}

}  // namespace fmi
