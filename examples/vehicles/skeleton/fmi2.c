/* fmi2Functions of an example: co-simulation, inputs with derivatives up to order 3, outputs with first derivatives,
 * snapshots that can be serialized. Nothing here knows which example it is. */
#include "fmi2Functions.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "simulation.h"

typedef enum Phase { instantiated, initializing, stepping, terminated } Phase;

typedef struct Snapshot {
  Simulation simulation;
  Phase phase;
} Snapshot;

typedef struct Instance {
  Snapshot of;
  fmi2CallbackLogger logger;
  fmi2ComponentEnvironment environment;
  char name[128];
} Instance;

static fmi2Status refuse(const Instance* i, const char* sentence) {
  if (i && i->logger) i->logger(i->environment, i->name, fmi2Error, "logStatusError", sentence);
  return fmi2Error;
}

const char* fmi2GetTypesPlatform(void) { return fmi2TypesPlatform; }
const char* fmi2GetVersion(void) { return fmi2Version; }

fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid, fmi2String resources,
                              const fmi2CallbackFunctions* callbacks, fmi2Boolean visible, fmi2Boolean logging) {
  if (type != fmi2CoSimulation || !name || !guid || strcmp(guid, MODEL_GUID) != 0) return NULL;
  Instance* i = calloc(1, sizeof *i);
  if (!i) return NULL;
  i->logger = callbacks ? callbacks->logger : NULL;
  i->environment = callbacks ? callbacks->componentEnvironment : NULL;
  snprintf(i->name, sizeof i->name, "%s", name);
  simulation_reset(&i->of.simulation);
  return i;
}

void fmi2FreeInstance(fmi2Component c) { free(c); }

fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean tolerance_defined, fmi2Real tolerance, fmi2Real start,
                               fmi2Boolean stop_defined, fmi2Real stop) {
  Now* now = &((Instance*)c)->of.simulation.now;
  now->t = now->begin = start;
  return fmi2OK;
}

static fmi2Status start(Instance* i, Phase next) {
  char sentence[sentence_size];
  const char* fault = simulation_start(&i->of.simulation, sentence);
  if (fault) return refuse(i, fault);
  i->of.phase = next;
  return fmi2OK;
}

fmi2Status fmi2EnterInitializationMode(fmi2Component c) { return start(c, initializing); }
fmi2Status fmi2ExitInitializationMode(fmi2Component c) { return start(c, stepping); }

fmi2Status fmi2Terminate(fmi2Component c) {
  ((Instance*)c)->of.phase = terminated;
  return fmi2OK;
}

fmi2Status fmi2Reset(fmi2Component c) {
  Instance* i = c;
  simulation_reset(&i->of.simulation);
  i->of.phase = instantiated;
  return fmi2OK;
}

/* Outputs are evaluated where the first of them is asked for. */
fmi2Status fmi2GetReal(fmi2Component c, const fmi2ValueReference v[], size_t n, fmi2Real values[]) {
  const Instance* i = c;
  double y[variable_count];
  int known = 0;
  for (size_t k = 0; k < n; ++k) {
    if (v[k] >= variable_count) return refuse(i, "fmi2GetReal: unknown value reference.");
    if (v[k] >= first_output && !known++) simulation_outputs(&i->of.simulation, y);
    values[k] = v[k] < first_output ? i->of.simulation.now.u[v[k]] : y[v[k]];
  }
  return fmi2OK;
}

fmi2Status fmi2SetReal(fmi2Component c, const fmi2ValueReference v[], size_t n, const fmi2Real values[]) {
  Instance* i = c;
  for (size_t k = 0; k < n; ++k) {
    if (v[k] >= first_output || !isfinite(values[k])) return refuse(i, "fmi2SetReal: not settable, or not finite.");
    if (v[k] < first_input && i->of.phase == stepping)
      return refuse(i, "fmi2SetReal: parameters are fixed once the run has begun.");
  }
  for (size_t k = 0; k < n; ++k) i->of.simulation.now.u[v[k]] = values[k];
  return fmi2OK;
}

fmi2Status fmi2SetRealInputDerivatives(fmi2Component c, const fmi2ValueReference v[], size_t n,
                                       const fmi2Integer orders[], const fmi2Real values[]) {
  Instance* i = c;
  for (size_t k = 0; k < n; ++k)
    if (v[k] < first_input || v[k] >= first_output || orders[k] < 1 || orders[k] > input_orders || !isfinite(values[k]))
      return refuse(i, "fmi2SetRealInputDerivatives: inputs have finite derivatives of order 1 to 3.");
  for (size_t k = 0; k < n; ++k) {
    i->of.simulation.slope[orders[k] - 1][v[k] - first_input] = values[k];
    i->of.simulation.given[v[k] - first_input] = 1;
  }
  return fmi2OK;
}

fmi2Status fmi2GetRealOutputDerivatives(fmi2Component c, const fmi2ValueReference v[], size_t n,
                                        const fmi2Integer orders[], fmi2Real values[]) {
  const Instance* i = c;
  double y_dot[variable_count];
  for (size_t k = 0; k < n; ++k)
    if (v[k] < first_output || v[k] >= variable_count || orders[k] != 1)
      return refuse(i, "fmi2GetRealOutputDerivatives: outputs have first derivatives only.");
  simulation_output_rates(&i->of.simulation, y_dot);
  for (size_t k = 0; k < n; ++k) values[k] = y_dot[v[k]];
  return fmi2OK;
}

fmi2Status fmi2DoStep(fmi2Component c, fmi2Real t, fmi2Real h, fmi2Boolean no_return) {
  Instance* i = c;
  if (i->of.phase != stepping) return refuse(i, "fmi2DoStep: the run has not begun, or it has ended.");
  if (!(h > 0) || !isfinite(t)) return refuse(i, "fmi2DoStep: the step must be above 0 s.");
  i->of.simulation.now.t = i->of.simulation.now.begin = t;
  simulation_step(&i->of.simulation, h);
  return fmi2OK;
}

fmi2Status fmi2GetFMUstate(fmi2Component c, fmi2FMUstate* state) {
  if (!*state) *state = malloc(sizeof(Snapshot));
  if (!*state) return refuse(c, "fmi2GetFMUstate: out of memory.");
  memcpy(*state, &((Instance*)c)->of, sizeof(Snapshot));
  return fmi2OK;
}

fmi2Status fmi2SetFMUstate(fmi2Component c, fmi2FMUstate state) {
  if (!state) return refuse(c, "fmi2SetFMUstate: no state is given.");
  memcpy(&((Instance*)c)->of, state, sizeof(Snapshot));
  return fmi2OK;
}

fmi2Status fmi2FreeFMUstate(fmi2Component c, fmi2FMUstate* state) {
  if (state) free(*state), *state = NULL;
  return fmi2OK;
}

fmi2Status fmi2SerializedFMUstateSize(fmi2Component c, fmi2FMUstate state, size_t* size) {
  *size = sizeof(Snapshot);
  return fmi2OK;
}

fmi2Status fmi2SerializeFMUstate(fmi2Component c, fmi2FMUstate state, fmi2Byte bytes[], size_t size) {
  if (!state || size < sizeof(Snapshot)) return refuse(c, "fmi2SerializeFMUstate: no state, or too few bytes.");
  memcpy(bytes, state, sizeof(Snapshot));
  return fmi2OK;
}

fmi2Status fmi2DeSerializeFMUstate(fmi2Component c, const fmi2Byte bytes[], size_t size, fmi2FMUstate* state) {
  if (size != sizeof(Snapshot)) return refuse(c, "fmi2DeSerializeFMUstate: these bytes are no state of this FMU.");
  const fmi2Status status = fmi2GetFMUstate(c, state);
  if (status == fmi2OK) memcpy(*state, bytes, size);
  return status;
}

/* What the examples do not have: variables of other types, directional derivatives, asynchronous steps. The functions
 * must exist all the same. */
#define UNUSED_TYPE(name, type)                                                             \
  fmi2Status name(fmi2Component c, const fmi2ValueReference v[], size_t n, type values[]) { \
    return n ? refuse(c, #name ": there are no variables of this type.") : fmi2OK;          \
  }
UNUSED_TYPE(fmi2GetInteger, fmi2Integer)
UNUSED_TYPE(fmi2GetBoolean, fmi2Boolean)
UNUSED_TYPE(fmi2GetString, fmi2String)
UNUSED_TYPE(fmi2SetInteger, const fmi2Integer)
UNUSED_TYPE(fmi2SetBoolean, const fmi2Boolean)
UNUSED_TYPE(fmi2SetString, const fmi2String)

#define STATUS_OF(name, type) \
  fmi2Status name(fmi2Component c, const fmi2StatusKind kind, type* value) { return fmi2Discard; }
STATUS_OF(fmi2GetStatus, fmi2Status)
STATUS_OF(fmi2GetRealStatus, fmi2Real)
STATUS_OF(fmi2GetIntegerStatus, fmi2Integer)
STATUS_OF(fmi2GetBooleanStatus, fmi2Boolean)
STATUS_OF(fmi2GetStringStatus, fmi2String)

fmi2Status fmi2SetDebugLogging(fmi2Component c, fmi2Boolean on, size_t n, const fmi2String categories[]) {
  return fmi2OK;
}

fmi2Status fmi2CancelStep(fmi2Component c) { return refuse(c, "fmi2CancelStep: no step is pending."); }

fmi2Status fmi2GetDirectionalDerivative(fmi2Component c, const fmi2ValueReference unknowns[], size_t n_unknowns,
                                        const fmi2ValueReference knowns[], size_t n_knowns, const fmi2Real seeds[],
                                        fmi2Real values[]) {
  return refuse(c, "fmi2GetDirectionalDerivative: not provided.");
}
