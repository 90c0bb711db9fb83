// One FMU instance: the master's callbacks and the simulation. And the guard every call passes.
#pragma once

#include "fmi2Functions.h"
#include "legality.hpp"
#include "simulation.hpp"

namespace fmi {

struct Instance {
  // One block of memory, the name included. What takes memory later: docs/decisions/memory.md. Null if there is none.
  static Instance* create(const char* name, const fmi2CallbackFunctions* callbacks, bool logging, wheel::Kind kind);
  static void destroy(Instance* instance);

  // Tells the master, if the category is switched on. Printf-like; the text is finished before the master sees it.
  void log(wheel::Topic topic, const char* format, ...);
  // Tells that a function is not legal in the present state, or belongs to the other kind of instance.
  void refuse(Function function, const char* name);
  bool wants(wheel::Topic topic) const { return logged_topics & (1u << static_cast<unsigned>(topic)); }

  wheel::Simulation simulation;
  bool busy = false;  // a call is under way: the logger must not call back into the instance
  unsigned logged_topics = 0;

 private:
  Instance(const fmi2CallbackFunctions* callbacks, wheel::Kind kind);
  fmi2CallbackLogger logger_ = nullptr;
  fmi2ComponentEnvironment environment_ = nullptr;
  const char* name_ = nullptr;  // behind the instance
};

// The category of a topic as modelDescription.xml names it.
const char* category_of(wheel::Topic topic);

// Every call on an instance: not null, not from within its own logger, legal in its state. An illegal call changes
// nothing.
template <class Body>
fmi2Status guarded(fmi2Component component, Function function, const char* name, Body&& body) {
  auto* instance = static_cast<Instance*>(component);
  if (!instance || instance->busy) return fmi2Error;
  instance->busy = true;
  fmi2Status status = fmi2Error;
  if (is_of_kind(function, instance->simulation.kind()) && is_legal(function, instance->simulation.phase()))
    status = body(*instance);
  else
    instance->refuse(function, name);
  instance->busy = false;
  return status;
}

}  // namespace fmi
