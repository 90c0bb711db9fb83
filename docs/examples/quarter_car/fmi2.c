/* fmi2Functions of the quarter car: co-simulation with input and output derivatives of first order and snapshots. */
#include "fmi2Functions.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "quarter_car.h"

typedef struct Instance {
  QuarterCar car;
  fmi2CallbackLogger logger;
  fmi2ComponentEnvironment environment;
  char name[128];
} Instance;

static fmi2Status refuse(const Instance* i, const char* sentence) {
  if (i->logger) i->logger(i->environment, i->name, fmi2Error, "logStatusError", sentence);
  return fmi2Error;
}

const char* fmi2GetTypesPlatform(void) { return fmi2TypesPlatform; }
const char* fmi2GetVersion(void) { return fmi2Version; }

fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid, fmi2String resources,
                              const fmi2CallbackFunctions* callbacks, fmi2Boolean visible, fmi2Boolean logging) {
  (void)resources, (void)visible, (void)logging;
  if (type != fmi2CoSimulation || !name || !guid || strcmp(guid, QUARTER_CAR_GUID) != 0) return NULL;
  Instance* i = calloc(1, sizeof *i);
  if (!i) return NULL;
  i->logger = callbacks ? callbacks->logger : NULL;
  i->environment = callbacks ? callbacks->componentEnvironment : NULL;
  snprintf(i->name, sizeof i->name, "%s", name);
  quarter_car_reset(&i->car);
  return i;
}

void fmi2FreeInstance(fmi2Component c) { free(c); }

fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean tolerance_defined, fmi2Real tolerance, fmi2Real start,
                               fmi2Boolean stop_defined, fmi2Real stop) {
  (void)tolerance_defined, (void)tolerance, (void)stop_defined, (void)stop;
  ((Instance*)c)->car.t = start;
  return fmi2OK;
}

fmi2Status fmi2EnterInitializationMode(fmi2Component c) {
  quarter_car_start(&((Instance*)c)->car);
  return fmi2OK;
}

fmi2Status fmi2ExitInitializationMode(fmi2Component c) { return fmi2EnterInitializationMode(c); }
fmi2Status fmi2Terminate(fmi2Component c) { return c ? fmi2OK : fmi2Error; }

fmi2Status fmi2Reset(fmi2Component c) {
  quarter_car_reset(&((Instance*)c)->car);
  return fmi2OK;
}

fmi2Status fmi2GetReal(fmi2Component c, const fmi2ValueReference v[], size_t n, fmi2Real values[]) {
  const Instance* i = c;
  for (size_t k = 0; k < n; ++k) {
    if (v[k] >= variable_count) return refuse(i, "fmi2GetReal: unknown value reference.");
    values[k] = quarter_car_value(&i->car, v[k]);
  }
  return fmi2OK;
}

fmi2Status fmi2SetReal(fmi2Component c, const fmi2ValueReference v[], size_t n, const fmi2Real values[]) {
  Instance* i = c;
  for (size_t k = 0; k < n; ++k)
    if (v[k] >= first_output || !isfinite(values[k])) return refuse(i, "fmi2SetReal: not settable, or not finite.");
  for (size_t k = 0; k < n; ++k) i->car.stored[v[k]] = values[k];
  return fmi2OK;
}

fmi2Status fmi2SetRealInputDerivatives(fmi2Component c, const fmi2ValueReference v[], size_t n,
                                       const fmi2Integer orders[], const fmi2Real values[]) {
  Instance* i = c;
  for (size_t k = 0; k < n; ++k)
    if (v[k] < first_input || v[k] >= first_output || orders[k] != 1)
      return refuse(i, "fmi2SetRealInputDerivatives: inputs have first derivatives only.");
  for (size_t k = 0; k < n; ++k) i->car.slope[v[k] - first_input] = values[k];
  return fmi2OK;
}

fmi2Status fmi2GetRealOutputDerivatives(fmi2Component c, const fmi2ValueReference v[], size_t n,
                                        const fmi2Integer orders[], fmi2Real values[]) {
  const Instance* i = c;
  for (size_t k = 0; k < n; ++k) {
    if (v[k] < first_output || v[k] >= variable_count || orders[k] != 1)
      return refuse(i, "fmi2GetRealOutputDerivatives: outputs have first derivatives only.");
    values[k] = quarter_car_rate(&i->car, v[k]);
  }
  return fmi2OK;
}

fmi2Status fmi2DoStep(fmi2Component c, fmi2Real t, fmi2Real h, fmi2Boolean no_return) {
  (void)no_return;
  Instance* i = c;
  i->car.t = t;
  quarter_car_step(&i->car, h);
  return fmi2OK;
}

fmi2Status fmi2GetFMUstate(fmi2Component c, fmi2FMUstate* state) {
  if (!*state) *state = malloc(sizeof(QuarterCar));
  if (!*state) return fmi2Error;
  memcpy(*state, &((Instance*)c)->car, sizeof(QuarterCar));
  return fmi2OK;
}

fmi2Status fmi2SetFMUstate(fmi2Component c, fmi2FMUstate state) {
  memcpy(&((Instance*)c)->car, state, sizeof(QuarterCar));
  return fmi2OK;
}

fmi2Status fmi2FreeFMUstate(fmi2Component c, fmi2FMUstate* state) {
  (void)c;
  free(*state);
  *state = NULL;
  return fmi2OK;
}

/* What the quarter car does not have: variables of other types, serialization, directional derivatives, asynchronous
 * steps. The functions must exist all the same. */
#define UNUSED_TYPE(name, type)                                                             \
  fmi2Status name(fmi2Component c, const fmi2ValueReference v[], size_t n, type values[]) { \
    (void)v, (void)values;                                                                  \
    return n ? refuse(c, #name ": there are no variables of this type.") : fmi2OK;          \
  }
UNUSED_TYPE(fmi2GetInteger, fmi2Integer)
UNUSED_TYPE(fmi2GetBoolean, fmi2Boolean)
UNUSED_TYPE(fmi2GetString, fmi2String)
UNUSED_TYPE(fmi2SetInteger, const fmi2Integer)
UNUSED_TYPE(fmi2SetBoolean, const fmi2Boolean)
UNUSED_TYPE(fmi2SetString, const fmi2String)

#define STATUS_OF(name, type)                                                \
  fmi2Status name(fmi2Component c, const fmi2StatusKind kind, type* value) { \
    (void)c, (void)kind, (void)value;                                        \
    return fmi2Discard;                                                      \
  }
STATUS_OF(fmi2GetStatus, fmi2Status)
STATUS_OF(fmi2GetRealStatus, fmi2Real)
STATUS_OF(fmi2GetIntegerStatus, fmi2Integer)
STATUS_OF(fmi2GetBooleanStatus, fmi2Boolean)
STATUS_OF(fmi2GetStringStatus, fmi2String)

fmi2Status fmi2SetDebugLogging(fmi2Component c, fmi2Boolean on, size_t n, const fmi2String categories[]) {
  (void)c, (void)on, (void)n, (void)categories;
  return fmi2OK;
}

fmi2Status fmi2CancelStep(fmi2Component c) { return refuse(c, "fmi2CancelStep: no step is pending."); }

fmi2Status fmi2SerializedFMUstateSize(fmi2Component c, fmi2FMUstate state, size_t* size) {
  (void)state, (void)size;
  return refuse(c, "fmi2SerializedFMUstateSize: not provided.");
}
fmi2Status fmi2SerializeFMUstate(fmi2Component c, fmi2FMUstate state, fmi2Byte bytes[], size_t size) {
  (void)state, (void)bytes, (void)size;
  return refuse(c, "fmi2SerializeFMUstate: not provided.");
}
fmi2Status fmi2DeSerializeFMUstate(fmi2Component c, const fmi2Byte bytes[], size_t size, fmi2FMUstate* state) {
  (void)bytes, (void)size, (void)state;
  return refuse(c, "fmi2DeSerializeFMUstate: not provided.");
}
fmi2Status fmi2GetDirectionalDerivative(fmi2Component c, const fmi2ValueReference unknowns[], size_t n_unknowns,
                                        const fmi2ValueReference knowns[], size_t n_knowns, const fmi2Real seeds[],
                                        fmi2Real values[]) {
  (void)unknowns, (void)n_unknowns, (void)knowns, (void)n_knowns, (void)seeds, (void)values;
  return refuse(c, "fmi2GetDirectionalDerivative: not provided.");
}
