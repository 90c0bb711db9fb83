// One FMU instance: the master's callbacks and the wheel. And the guard every call passes.
#pragma once

#include <type_traits>

#include "arithmetic.hpp"
#include "fmi2Functions.h"
#include "handle.hpp"
#include "legality.hpp"
#include "wheel.hpp"

namespace fmi {

struct Instance : Handle {
  static constexpr std::uint64_t own_mark = 0x495f554d46484557;  // "WEHFMU_I"

  // One block of memory, the name included. What takes memory later: docs/decisions/package.md. Null if there is none.
  static Instance* create(const char* name, const fmi2CallbackFunctions* callbacks, bool logging, wheel::Kind kind);

  // Passes a message to the master, if its category is switched on: printf-like, the name of the function under way
  // first. Returns the status of a call that ends with this message.
  template <class... Numbers>
  fmi2Status log(wheel::Topic topic, const char* format, Numbers... numbers) const {
    reporter.log(topic, format, called, numbers...);
    return status_of(topic);
  }
  // Whether the call is sound; if not, the error is logged.
  template <class... Numbers>
  bool check(bool sound, const char* format, Numbers... numbers) const {
    return reporter.check(sound, format, called, numbers...);
  }
  // The end of a call by what is wrong; null: nothing.
  fmi2Status fail(const char* fault) const { return fault ? log(wheel::Topic::error, "%s: %s.", fault) : fmi2OK; }
  // Arrays that must have `count` entries.
  bool check_arrays(std::size_t count, const void* references, const void* values) const {
    return check(!count || (references && values), "%s: an array is a null pointer.");
  }
  // Calculated variables can be read once there is a state: in initialization mode the start state, Discard while the
  // parameters are faulty. Parameters and inputs always can.
  fmi2Status prepare_reading(const fmi2ValueReference variables[], std::size_t count);
  // Logs that a function is not legal in the present state, or belongs to the other kind of instance.
  fmi2Status refuse(const Rule& rule);

  const wheel::Reporter reporter;
  wheel::Wheel wheel;
  // The function that is under way, for messages; null: none is. The logger must not call back into the instance.
  const char* called = nullptr;
  unsigned logged_topics = 0;
  mutable Arithmetic arithmetic;  // given back to the host while its logger runs

 private:
  Instance(const fmi2CallbackFunctions* callbacks, wheel::Kind kind);
  static bool listens(const void* instance, wheel::Topic topic);
  static void take(const void* instance, wheel::Topic topic, const char* message);
  static fmi2Status status_of(wheel::Topic topic);

  fmi2CallbackLogger logger_ = nullptr;
  fmi2ComponentEnvironment environment_ = nullptr;
  const char* name_ = nullptr;  // behind the instance
};

// The category of a topic as modelDescription.xml names it.
const char* category_of(wheel::Topic topic);

inline constexpr const char* no_fault = nullptr;

// Every call on an instance: one of this library, not from within its own logger, legal in its state. An illegal call
// changes nothing. The body returns a status, or what is wrong; one without a result cannot fail.
template <class Body>
fmi2Status guarded(fmi2Component component, const Rule& rule, const char* name, Body&& body) {
  auto* const instance = handle_of<Instance>(component);
  if (!instance || instance->called) return fmi2Error;
  instance->called = name;
  if (!rule.reads) instance->wheel.reading.forget();
  instance->arithmetic.take();
  fmi2Status status = fmi2OK;
  if (!rule.allows(instance->wheel.kind(), instance->wheel.phase()))
    status = instance->refuse(rule);
  else if constexpr (std::is_void_v<decltype(body(*instance))>)
    body(*instance);
  else if constexpr (std::is_same_v<decltype(body(*instance)), const char*>)
    status = instance->fail(body(*instance));
  else
    status = body(*instance);
  instance->arithmetic.give_back();
  instance->called = nullptr;
  return status;
}

}  // namespace fmi
