// FMI 2.0 functions: instantiation, initialization, termination, reset, logging, stepping, status.
#include <cmath>
#include <cstdlib>
#include <cstring>

#include "instance.hpp"
#include "registry.hpp"

using fmi::Function, fmi::guarded, fmi::Instance, fmi::State, wheel::Topic;

namespace {

// Masters carry rounding in times: this much, relative to the step and to the times at hand, counts as equal.
constexpr double step_rounding = 1e-9, time_rounding = 1e-13;

bool same_time(double a, double b, double step) {
  return std::fabs(a - b) <= step_rounding * step + time_rounding * (std::fabs(a) + std::fabs(b));
}

// A sum of many steps may miss the stop time by more.
bool is_past(double t, double stop) { return t - stop > step_rounding * (std::fabs(t) + std::fabs(stop)); }

bool is_blank(const char* text) { return !text || text[std::strspn(text, " \t\r\n")] == 0; }

void complain(const fmi2CallbackFunctions* callbacks, const char* name, const char* message) {
  if (callbacks && callbacks->logger)
    callbacks->logger(callbacks->componentEnvironment, name ? name : "", fmi2Error, "logStatusError", message);
}

// Null where the instance may be created, else the reason why not.
const char* refusal(const char* name, fmi2Type type, const char* guid) {
  if (is_blank(name)) return "fmi2Instantiate: the instance name is missing or blank.";
  if (type != fmi2CoSimulation) return "fmi2Instantiate: this FMU is for co-simulation only.";
  if (!guid || std::strcmp(guid, WHEEL_GUID) != 0)
    return "fmi2Instantiate: the GUID is not that of this FMU's modelDescription.xml (" WHEEL_GUID ").";
  return nullptr;
}

fmi2Status check_step(Instance& i, double t, double h) {
  if (!std::isfinite(t) || !std::isfinite(h) || h < 0) {
    i.log(Topic::error, "fmi2DoStep from %.17g s by %.17g s: times must be finite and the step not negative.", t, h);
    return fmi2Error;
  }
  if (!same_time(t, i.simulation.time(), h)) {
    i.log(Topic::error, "fmi2DoStep from %.17g s: the wheel stands at %.17g s.", t, i.simulation.time());
    return fmi2Error;
  }
  if (i.has_stop_time && is_past(t + h, i.stop_time)) {
    i.log(Topic::error, "fmi2DoStep to %.17g s: the stop time is %.17g s.", t + h, i.stop_time);
    return fmi2Error;
  }
  return fmi2OK;
}

fmi2Status step(Instance& i, double t, double h) {
  if (check_step(i, t, h) != fmi2OK) return fmi2Error;
  switch (i.simulation.advance(t + h)) {
    case wheel::Progressed::reached:
      return i.last_step = fmi2OK;
    case wheel::Progressed::ended:
      i.state = State::step_failed;
      return i.last_step = fmi2Discard;
    case wheel::Progressed::failed:
      break;
  }
  i.state = State::error;
  return i.last_step = fmi2Error;
}

// Topics of one category; logAll names them all, an unknown one none.
unsigned topics_of(const char* category) {
  unsigned topics = 0;
  for (const Topic topic : {Topic::event, Topic::warning, Topic::error, Topic::discard})
    if (category && (!std::strcmp(category, "logAll") || !std::strcmp(category, fmi::category_of(topic))))
      topics |= 1u << static_cast<unsigned>(topic);
  return topics;
}

fmi2Status switch_logging(Instance& i, bool on, std::size_t count, const fmi2String categories[]) {
  if (count && !categories) {
    i.log(Topic::error, "fmi2SetDebugLogging: the categories are a null pointer.");
    return fmi2Error;
  }
  unsigned topics = count ? 0 : topics_of("logAll");
  for (std::size_t k = 0; k < count; ++k) {
    topics |= topics_of(categories[k]);
    if (!topics_of(categories[k]))
      i.log(Topic::warning, "fmi2SetDebugLogging: there is no category \"%s\".", categories[k] ? categories[k] : "");
  }
  i.logged_topics = on ? (count ? topics : i.logged_topics | topics) : i.logged_topics & ~topics;
  return fmi2OK;
}

constexpr int no_status = -1;

// One kind of status per function; for every other kind there is nothing to tell: Discard.
template <class Value, class Read>
fmi2Status get_status(fmi2Component c, const char* name, int kind, int known_kind, Value* value, Read read) {
  return guarded(c, Function::get_status, name, [=](Instance& i) {
    if (!value) {
      i.log(Topic::error, "%s: the value is a null pointer.", name);
      return fmi2Error;
    }
    if (kind != known_kind) {
      i.log(Topic::discard, "%s: there is no status of kind %d.", name, kind);
      return fmi2Discard;
    }
    *value = read(i);
    return fmi2OK;
  });
}

}  // namespace

extern "C" {

const char* fmi2GetTypesPlatform() { return fmi2TypesPlatform; }
const char* fmi2GetVersion() { return fmi2Version; }

fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid, fmi2String,
                              const fmi2CallbackFunctions* callbacks, fmi2Boolean, fmi2Boolean logging) {
  if (const char* reason = refusal(name, type, guid)) {
    complain(callbacks, name, reason);
    return nullptr;
  }
  Instance* instance = Instance::create(name, callbacks, logging != fmi2False);
  if (instance && fmi::remember_instance(instance)) return instance;
  if (instance) Instance::destroy(instance);
  complain(callbacks, name, "fmi2Instantiate: memory is short.");
  return nullptr;
}

void fmi2FreeInstance(fmi2Component c) {
  auto* instance = static_cast<Instance*>(c);
  if (instance && fmi::is_live_instance(instance) && !instance->busy && fmi::forget_instance(instance))
    Instance::destroy(instance);
}

fmi2Status fmi2SetDebugLogging(fmi2Component c, fmi2Boolean on, size_t count, const fmi2String categories[]) {
  return guarded(c, Function::set_debug_logging, "fmi2SetDebugLogging",
                 [&](Instance& i) { return switch_logging(i, on != fmi2False, count, categories); });
}

fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean has_tolerance, fmi2Real tolerance, fmi2Real start,
                               fmi2Boolean has_stop, fmi2Real stop) {
  return guarded(c, Function::setup_experiment, "fmi2SetupExperiment", [&](Instance& i) {
    if (!std::isfinite(start) || (has_stop && !(stop >= start)) || (has_tolerance && !(tolerance > 0))) {
      i.log(Topic::error,
            "fmi2SetupExperiment: start %g s, stop %g s, tolerance %g: start must be finite, stop not "
            "before it, the tolerance positive.",
            start, stop, tolerance);
      return fmi2Error;
    }
    i.has_stop_time = has_stop;
    i.stop_time = stop;
    i.simulation.set_experiment(start, has_tolerance ? tolerance : 0);
    return fmi2OK;
  });
}

fmi2Status fmi2EnterInitializationMode(fmi2Component c) {
  return guarded(c, Function::enter_initialization, "fmi2EnterInitializationMode", [](Instance& i) {
    i.state = State::initialization;
    i.prepared = false;
    return fmi2OK;
  });
}

fmi2Status fmi2ExitInitializationMode(fmi2Component c) {
  return guarded(c, Function::exit_initialization, "fmi2ExitInitializationMode", [](Instance& i) {
    const bool sound = i.simulation.prepare();
    const bool started = sound && i.simulation.start();
    if (sound && !started) i.log(Topic::error, "fmi2ExitInitializationMode: the solver does not start.");
    i.state = started ? State::step_complete : State::error;
    return started ? fmi2OK : fmi2Error;
  });
}

fmi2Status fmi2Terminate(fmi2Component c) {
  if (!fmi::is_live_instance(c)) return fmi2Error;
  return guarded(c, Function::terminate, "fmi2Terminate", [](Instance& i) {
    i.state = State::terminated;
    return fmi2OK;
  });
}

fmi2Status fmi2Reset(fmi2Component c) {
  if (!fmi::is_live_instance(c)) return fmi2Error;
  return guarded(c, Function::reset, "fmi2Reset", [](Instance& i) {
    i.simulation.reset();
    i.state = State::instantiated;
    i.prepared = i.faults_told = i.has_stop_time = false;
    i.last_step = fmi2OK;
    return fmi2OK;
  });
}

fmi2Status fmi2DoStep(fmi2Component c, fmi2Real t, fmi2Real h, fmi2Boolean) {
  return guarded(c, Function::do_step, "fmi2DoStep", [=](Instance& i) { return step(i, t, h); });
}

fmi2Status fmi2CancelStep(fmi2Component c) {
  return guarded(c, Function::cancel_step, "fmi2CancelStep", [](Instance&) { return fmi2Error; });
}

fmi2Status fmi2GetStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Status* value) {
  return get_status(c, "fmi2GetStatus", kind, fmi2DoStepStatus, value, [](Instance& i) { return i.last_step; });
}

fmi2Status fmi2GetRealStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Real* value) {
  return get_status(c, "fmi2GetRealStatus", kind, fmi2LastSuccessfulTime, value,
                    [](Instance& i) { return i.simulation.time(); });
}

fmi2Status fmi2GetIntegerStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Integer* value) {
  return get_status(c, "fmi2GetIntegerStatus", kind, no_status, value, [](Instance&) { return 0; });
}

fmi2Status fmi2GetBooleanStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Boolean* value) {
  return get_status(c, "fmi2GetBooleanStatus", kind, fmi2Terminated, value,
                    [](Instance& i) { return i.last_step == fmi2Discard ? fmi2True : fmi2False; });
}

fmi2Status fmi2GetStringStatus(fmi2Component c, const fmi2StatusKind kind, fmi2String* value) {
  return get_status(c, "fmi2GetStringStatus", kind, fmi2PendingStatus, value, [](Instance&) { return ""; });
}

}  // extern "C"
