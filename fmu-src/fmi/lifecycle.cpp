// FMI 2.0 functions: instantiation, initialization, termination, reset, logging.
#include <bit>
#include <cmath>
#include <cstring>

#include "instance.hpp"
#include "setting.hpp"
#include "transitions.hpp"

using fmi::guarded, fmi::Instance, wheel::Topic;
namespace legality = fmi::legality;

namespace {

bool is_blank(const char* text) { return !text || text[std::strspn(text, " \t\r\n")] == 0; }

// Null where the instance may be created, else the reason why not. A number outside of the enumeration cannot be read
// as its type.
const char* refusal(const char* name, const fmi2Type& asked, const char* guid) {
  const int type = std::bit_cast<int>(asked);
  if (is_blank(name)) return "fmi2Instantiate: the instance name is missing or blank.";
  if (type != fmi2CoSimulation && type != fmi2ModelExchange) return "fmi2Instantiate: the type is not known.";
  if (!guid || std::strcmp(guid, WHEEL_GUID) != 0)
    return "fmi2Instantiate: the GUID differs from this FMU's modelDescription.xml (" WHEEL_GUID ").";
  return nullptr;
}

// (category) => its topics: of logAll all, of an unknown one none
unsigned topics_of(const char* category) {
  unsigned topics = 0;
  for (const Topic topic : {Topic::event, Topic::warning, Topic::error, Topic::discard})
    if (category && (!std::strcmp(category, "logAll") || !std::strcmp(category, fmi::category_of(topic).name)))
      topics |= fmi::bits(topic);
  return topics;
}

fmi2Status switch_logging(Instance& i, bool on, std::size_t count, const fmi2String categories[]) {
  if (count && !categories) return i.log(Topic::error, "%s: the categories are a null pointer.");
  unsigned topics = count ? 0 : topics_of("logAll");
  for (std::size_t k = 0; k < count; ++k) {
    topics |= topics_of(categories[k]);
    if (!topics_of(categories[k]))
      i.log(Topic::warning, "%s: there is no category \"%s\".", categories[k] ? categories[k] : "");
  }
  i.logged_topics = on ? (count ? topics : i.logged_topics | topics) : i.logged_topics & ~topics;
  return fmi2OK;
}

}  // namespace

const char* fmi2GetTypesPlatform() { return fmi2TypesPlatform; }
const char* fmi2GetVersion() { return fmi2Version; }

fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid, fmi2String,
                              const fmi2CallbackFunctions* callbacks, fmi2Boolean, fmi2Boolean logging) {
  const char* const reason = refusal(name, type, guid);
  const bool slave = !reason && type == fmi2CoSimulation;
  const auto kind = slave ? wheel::Kind::co_simulation : wheel::Kind::model_exchange;
  Instance* const instance = reason ? nullptr : Instance::create(name, callbacks, logging != fmi2False, kind);
  if (!instance && callbacks && callbacks->logger)
    callbacks->logger(callbacks->componentEnvironment, name ? name : "", fmi2Error, "logStatusError",
                      reason ? reason : "fmi2Instantiate: out of memory.");
  return static_cast<fmi::Handle*>(instance);
}

void fmi2FreeInstance(fmi2Component c) {
  auto* const instance = fmi::handle_of<Instance>(c);
  if (instance && !instance->called) fmi::release(instance);
}

fmi2Status fmi2SetDebugLogging(fmi2Component c, fmi2Boolean on, size_t count, const fmi2String categories[]) {
  return guarded(c, legality::always,
                 [&](Instance& i) { return switch_logging(i, on != fmi2False, count, categories); });
}

fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean has_tolerance, fmi2Real tolerance, fmi2Real start,
                               fmi2Boolean has_stop, fmi2Real stop) {
  return guarded(c, legality::before_initialization, [&](Instance& i) {
    if (!i.check(std::isfinite(start), "%s: start %s s: it must be finite.", start) ||
        !i.check(!has_stop || stop >= start, "%s: stop %s s: it must not lie before the start, %s s.", stop, start) ||
        !i.check(!has_tolerance || tolerance > 0, "%s: tolerance %s: it must be positive.", tolerance))
      return fmi2Error;
    wheel::set_experiment(i.change(), start, has_stop ? stop : solver::never, has_tolerance ? tolerance : 0);
    return fmi2OK;
  });
}

fmi2Status fmi2EnterInitializationMode(fmi2Component c) {
  return guarded(c, legality::before_initialization, [](Instance& i) { wheel::begin_initialization(i.change()); });
}

fmi2Status fmi2ExitInitializationMode(fmi2Component c) {
  return guarded(c, legality::exit_initialization,
                 [](Instance& i) { return wheel::end_initialization(i.change()) ? fmi2OK : fmi2Error; });
}

fmi2Status fmi2Terminate(fmi2Component c) {
  return guarded(c, legality::terminate, [](Instance& i) { wheel::close(i.change()); });
}

fmi2Status fmi2Reset(fmi2Component c) {
  return guarded(c, legality::always, [](Instance& i) { wheel::reset(i.change()); });
}
