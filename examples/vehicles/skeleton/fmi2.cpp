/* fmi2Functions of an example: co-simulation, inputs with derivatives up to order 3, outputs with first derivatives,
 * snapshots. Nothing here depends on the example. */
#include "fmi2Functions.h"

#include <cstring>
#include <functional>
#include <new>
#include <string>
#include <utility>

#include "simulation.hpp"

using Component = fmi2Component;
using Refs = const fmi2ValueReference*;
using Orders = const fmi2Integer*;

struct Instance {
  Simulation simulation;
  std::string name;
  fmi2CallbackFunctions callbacks;
};

/* Runs a call; what it throws is logged and refused. */
template <class Act>
static fmi2Status run(Component c, Act act) {
  auto& [simulation, name, to] = *static_cast<Instance*>(c);
  try {
    std::invoke(act, simulation);
    return fmi2OK;
  } catch (const std::exception& fault) {
    if (to.logger) to.logger(to.componentEnvironment, name.c_str(), fmi2Error, "logStatusError", fault.what());
    return fmi2Error;
  }
}

static void require(bool met, const char* message) {
  if (!met) throw std::invalid_argument(message);
}

/* Of what the examples do not have; its functions must exist all the same. */
static fmi2Status refuse(Component c, bool asked = true) {
  return run(c, [&](Simulation&) { require(!asked, "There is no such variable, derivative or function."); });
}

const char* fmi2GetTypesPlatform() { return fmi2TypesPlatform; }
const char* fmi2GetVersion() { return fmi2Version; }

fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid, fmi2String,
                              const fmi2CallbackFunctions* callbacks, fmi2Boolean, fmi2Boolean) {
  if (type != fmi2CoSimulation || !name || !guid || std::strcmp(guid, MODEL_GUID) != 0) return nullptr;
  return new (std::nothrow) Instance{{}, name, callbacks ? *callbacks : fmi2CallbackFunctions{}};
}

void fmi2FreeInstance(Component c) { delete static_cast<Instance*>(c); }

fmi2Status fmi2SetupExperiment(Component c, fmi2Boolean, fmi2Real, fmi2Real start, fmi2Boolean, fmi2Real) {
  return run(c, [&](Simulation& s) { s.now.t = s.now.begin = start; });
}

fmi2Status fmi2EnterInitializationMode(Component c) { return run(c, &Simulation::start); }
fmi2Status fmi2ExitInitializationMode(Component c) { return run(c, &Simulation::go); }
fmi2Status fmi2Terminate(Component c) { return run(c, &Simulation::stop); }
fmi2Status fmi2Reset(Component c) { return run(c, &Simulation::reset); }

fmi2Status fmi2GetReal(Component c, Refs v, size_t n, fmi2Real values[]) {
  return run(c, [&](const Simulation& s) {
    require(std::all_of(v, v + n, [](auto r) { return r < variable_count; }), "fmi2GetReal: unknown value reference.");
    std::transform(v, v + n, values, [y = values_at(s.now, s.x)](auto r) { return y[r]; });
  });
}

fmi2Status fmi2SetReal(Component c, Refs v, size_t n, const fmi2Real values[]) {
  return run(c, [&](Simulation& s) {
    for (size_t k = 0; k < n; ++k) {
      require(v[k] < first_output && std::isfinite(values[k]), "fmi2SetReal: not settable, or not finite.");
      require(v[k] >= first_input || !s.running, "fmi2SetReal: parameters are fixed once the run has begun.");
      s.now.u[v[k]] = values[k];
    }
  });
}

fmi2Status fmi2SetRealInputDerivatives(Component c, Refs v, size_t n, Orders orders, const fmi2Real values[]) {
  return run(c, [&](Simulation& s) {
    for (size_t k = 0; k < n; ++k) {
      const bool input = v[k] >= first_input && v[k] < first_output && std::isfinite(values[k]);
      require(input && orders[k] >= 1 && orders[k] <= Simulation::orders,
              "fmi2SetRealInputDerivatives: inputs have finite derivatives of order 1 to 3.");
      s.slope[orders[k] - 1][v[k] - first_input] = values[k];
      s.given[v[k] - first_input] = true;
    }
  });
}

fmi2Status fmi2GetRealOutputDerivatives(Component c, Refs v, size_t n, Orders orders, fmi2Real values[]) {
  return run(c, [&](const Simulation& s) {
    for (size_t k = 0; k < n; ++k)
      require(v[k] >= first_output && v[k] < variable_count && orders[k] == 1,
              "fmi2GetRealOutputDerivatives: outputs have first derivatives only.");
    std::transform(v, v + n, values, [y_dot = s.output_rates()](auto r) { return y_dot[r]; });
  });
}

fmi2Status fmi2DoStep(Component c, fmi2Real t, fmi2Real h, fmi2Boolean) {
  return run(c, [&](Simulation& s) {
    require(s.running, "fmi2DoStep: the run has not begun, or it has ended.");
    require(h > 0 && std::isfinite(t), "fmi2DoStep: the step must be above 0 s.");
    s.step(t, h);
  });
}

fmi2Status fmi2GetFMUstate(Component c, fmi2FMUstate* state) {
  return run(c, [&](const Simulation& s) {
    if (!*state) *state = new Simulation;
    *static_cast<Simulation*>(*state) = s;
  });
}

fmi2Status fmi2SetFMUstate(Component c, fmi2FMUstate state) {
  return run(c, [&](Simulation& s) {
    require(state, "fmi2SetFMUstate: no state is given.");
    s = *static_cast<Simulation*>(state);
  });
}

fmi2Status fmi2FreeFMUstate(Component, fmi2FMUstate* state) {
  if (state) delete static_cast<Simulation*>(std::exchange(*state, nullptr));
  return fmi2OK;
}

/* Snapshots stay in their process. */
fmi2Status fmi2SerializedFMUstateSize(Component c, fmi2FMUstate, size_t*) { return refuse(c); }
fmi2Status fmi2SerializeFMUstate(Component c, fmi2FMUstate, fmi2Byte[], size_t) { return refuse(c); }
fmi2Status fmi2DeSerializeFMUstate(Component c, const fmi2Byte[], size_t, fmi2FMUstate*) { return refuse(c); }

/* Variables of other types: none of them may be asked for. */
fmi2Status fmi2GetInteger(Component c, Refs, size_t n, fmi2Integer[]) { return refuse(c, n); }
fmi2Status fmi2GetBoolean(Component c, Refs, size_t n, fmi2Boolean[]) { return refuse(c, n); }
fmi2Status fmi2GetString(Component c, Refs, size_t n, fmi2String[]) { return refuse(c, n); }
fmi2Status fmi2SetInteger(Component c, Refs, size_t n, const fmi2Integer[]) { return refuse(c, n); }
fmi2Status fmi2SetBoolean(Component c, Refs, size_t n, const fmi2Boolean[]) { return refuse(c, n); }
fmi2Status fmi2SetString(Component c, Refs, size_t n, const fmi2String[]) { return refuse(c, n); }

fmi2Status fmi2GetStatus(Component, const fmi2StatusKind, fmi2Status*) { return fmi2Discard; }
fmi2Status fmi2GetRealStatus(Component, const fmi2StatusKind, fmi2Real*) { return fmi2Discard; }
fmi2Status fmi2GetIntegerStatus(Component, const fmi2StatusKind, fmi2Integer*) { return fmi2Discard; }
fmi2Status fmi2GetBooleanStatus(Component, const fmi2StatusKind, fmi2Boolean*) { return fmi2Discard; }
fmi2Status fmi2GetStringStatus(Component, const fmi2StatusKind, fmi2String*) { return fmi2Discard; }

fmi2Status fmi2SetDebugLogging(Component, fmi2Boolean, size_t, const fmi2String[]) { return fmi2OK; }

fmi2Status fmi2CancelStep(Component c) { return refuse(c); }

fmi2Status fmi2GetDirectionalDerivative(Component c, Refs, size_t, Refs, size_t, const fmi2Real[], fmi2Real[]) {
  return refuse(c);
}
