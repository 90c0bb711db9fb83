// One FMU instance: the master's callbacks and the wheel. And the guard every call passes.
#pragma once

#include <bit>
#include <cstdlib>
#include <optional>
#include <type_traits>

#include "arithmetic.hpp"
#include "fmi2Functions.h"
#include "legality.hpp"
#include "wheel.hpp"

namespace fmi {

// What is handed out to a master, which passes it back: instances and FMU states. Each begins with the mark of its
// kind, so that a call checks a pointer without a list of all that are alive.
struct Handle {
  // Some masters pass a state where its address belongs; what they free is this null pointer.
  const void* none = nullptr;
  volatile std::uint64_t mark;  // else compilers drop the store that wipes it before the memory is freed
};

// (pointer) => the same, null unless it is one of this kind. If not null, it must point to memory that can be read.
template <class Handled>
Handled* handle_of(void* passed) {
  auto* const handle = static_cast<Handle*>(passed);
  if (!handle || std::bit_cast<std::uintptr_t>(handle) % alignof(Handle) != 0) return nullptr;
  return handle->mark == Handled::kind_mark ? static_cast<Handled*>(handle) : nullptr;
}

template <class Handled>
void release(Handled* handle) {
  handle->mark = 0;
  handle->~Handled();
  std::free(handle);
}

// (topic) => its category as modelDescription.xml names it, the status of its messages, and that of a call that ends
// with one. At their default level many masters hide messages of the status Discard.
struct Category {
  const char* name;
  fmi2Status message, call;
};
constexpr Category category_of(wheel::Topic topic) {
  constexpr Category categories[] = {{"logEvents", fmi2OK, fmi2OK},
                                     {"logStatusWarning", fmi2Warning, fmi2OK},
                                     {"logStatusError", fmi2Error, fmi2Error},
                                     {"logStatusDiscard", fmi2Warning, fmi2Discard}};
  return categories[static_cast<unsigned>(topic)];
}

struct Instance final : Handle, wheel::Reporter {
  static constexpr std::uint64_t kind_mark = 0x495f554d46484557;  // "WEHFMU_I"

  // One block of memory, the name included. What takes memory later: docs/decisions/package.md. Null if there is none.
  static Instance* create(const char* name, const fmi2CallbackFunctions* callbacks, bool logging, wheel::Kind kind);

  // Passes a message to the master, if its category is switched on: printf-like, the name of the function under way
  // first. Returns the status of a call that ends with this message.
  template <class... Numbers>
  fmi2Status log(wheel::Topic topic, const char* format, Numbers... numbers) const {
    Reporter::log(topic, format, called, numbers...);
    return category_of(topic).call;
  }
  // Whether the call is sound; if not, the error is logged.
  template <class... Numbers>
  bool check(bool sound, const char* format, Numbers... numbers) const {
    return Reporter::check(sound, format, called, numbers...);
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

  const wheel::Wheel& wheel = wheel_;
  // The only way to change the wheel: what was read of it is dropped.
  wheel::Wheel& change() {
    reading_.reset();
    return wheel_;
  }
  // Parameters and inputs as they were set; calculated variables at the instant reached, where what was set takes
  // effect at once.
  double value_of(unsigned variable);
  // The function that is under way, for messages; null: none is. The logger must not call back into the instance.
  const char* called = nullptr;
  unsigned logged_topics = 0;
  mutable Arithmetic arithmetic;  // given back to the host while its logger runs

 private:
  Instance(const fmi2CallbackFunctions* callbacks, wheel::Kind kind);
  bool listens(wheel::Topic topic) const override { return callbacks_.logger && logged_topics & bits(topic); }
  void take(wheel::Topic topic, const char* message) const override;

  const fmi2CallbackFunctions callbacks_;  // a copy: the master's pointer need not live longer than the creation
  const char* name_ = nullptr;             // behind the instance
  wheel::Wheel wheel_;
  std::optional<wheel::Reading> reading_;  // of the instant reached
};

inline constexpr const char* no_fault = nullptr;

// Every call on an instance: one of this library, not from within its logger, legal in its state. An illegal call
// changes nothing. The body returns a status, or what is wrong; one without a result cannot fail. `name` is that of the
// calling function.
template <class Body>
fmi2Status guarded(fmi2Component component, const Rule& rule, Body&& body, const char* name = __builtin_FUNCTION()) {
  auto* const instance = handle_of<Instance>(component);
  if (!instance || instance->called) return fmi2Error;
  instance->called = name;
  instance->arithmetic.take();
  fmi2Status status = fmi2OK;
  if (!rule.allows(instance->wheel.demand.kind, instance->wheel.run.phase))
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
