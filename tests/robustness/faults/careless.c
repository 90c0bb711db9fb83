/* A unit with one flaw, which faults.c must find: compiled with -DFLAW=CRASHES and so on; without a flaw for
 * -DFLAW=NONE. It counts, and takes memory at the start of each run. No paper equation, no frame. */
#include <stdlib.h>
#include <string.h>

#include "fmi2Functions.h"

enum Flaw { NONE, CRASHES, HANGS, LEAKS, KEEPS_SILENT, STAYS_BROKEN, COUNTS_ELSE, READS_UNWRITTEN };

typedef struct Instance {
  double count, unwritten, *work;
  int broken;
  const fmi2CallbackFunctions* callbacks;
} Instance;

static fmi2Status refuse(const fmi2CallbackFunctions* callbacks) {
  if (callbacks && callbacks->logger && FLAW != KEEPS_SILENT)
    callbacks->logger(NULL, "careless", fmi2Error, "logStatusError", "out of memory");
  return fmi2Error;
}

fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid, fmi2String resources,
                              const fmi2CallbackFunctions* callbacks, fmi2Boolean visible, fmi2Boolean logging) {
  (void)name, (void)type, (void)guid, (void)resources, (void)visible, (void)logging;
  Instance* i = malloc(sizeof *i);
  if (!i) return refuse(callbacks), NULL;
  i->count = i->broken = 0;
  i->work = NULL;
  i->callbacks = callbacks;
  return i;
}

fmi2Status fmi2ExitInitializationMode(fmi2Component c) {
  Instance* i = c;
  do i->work = malloc(sizeof *i->work);
  while (!i->work && FLAW == HANGS);
  if (FLAW == CRASHES) *i->work = 0;
  if (i->work && !i->broken) return fmi2OK;
  if (FLAW == STAYS_BROKEN) i->broken = 1;
  if (FLAW == COUNTS_ELSE) return i->count = 1, fmi2OK;
  return refuse(i->callbacks);
}

fmi2Status fmi2Reset(fmi2Component c) {
  Instance* i = c;
  if (FLAW != LEAKS) free(i->work);
  i->work = NULL;
  i->count = 0;
  return fmi2OK;
}

void fmi2FreeInstance(fmi2Component c) {
  fmi2Reset(c);
  free(c);
}

fmi2Status fmi2DoStep(fmi2Component c, fmi2Real t, fmi2Real h, fmi2Boolean no_set_state) {
  (void)t, (void)h, (void)no_set_state;
  ++((Instance*)c)->count;
  return fmi2OK;
}

fmi2Status fmi2GetReal(fmi2Component c, const fmi2ValueReference v[], size_t n, fmi2Real values[]) {
  (void)v;
  const Instance* i = c;
  for (size_t k = 0; k < n; ++k) values[k] = i->count;
  if (FLAW == READS_UNWRITTEN) memcpy(values, &i->unwritten, sizeof *values);
  return fmi2OK;
}

fmi2Status fmi2GetFMUstate(fmi2Component c, fmi2FMUstate* state) {
  if (!*state) *state = malloc(sizeof(double));
  if (!*state) return refuse(((Instance*)c)->callbacks);
  memcpy(*state, &((Instance*)c)->count, sizeof(double));
  return fmi2OK;
}

fmi2Status fmi2SetFMUstate(fmi2Component c, fmi2FMUstate state) {
  memcpy(&((Instance*)c)->count, state, sizeof(double));
  return fmi2OK;
}

fmi2Status fmi2FreeFMUstate(fmi2Component c, fmi2FMUstate* state) {
  (void)c;
  free(*state);
  *state = NULL;
  return fmi2OK;
}

fmi2Status fmi2SerializedFMUstateSize(fmi2Component c, fmi2FMUstate state, size_t* size) {
  (void)c, (void)state;
  *size = sizeof(double);
  return fmi2OK;
}

fmi2Status fmi2SerializeFMUstate(fmi2Component c, fmi2FMUstate state, fmi2Byte bytes[], size_t size) {
  (void)c;
  memcpy(bytes, state, size);
  return fmi2OK;
}

fmi2Status fmi2DeSerializeFMUstate(fmi2Component c, const fmi2Byte bytes[], size_t size, fmi2FMUstate* state) {
  if (!*state) *state = malloc(size);
  if (!*state) return refuse(((Instance*)c)->callbacks);
  memcpy(*state, bytes, size);
  return fmi2OK;
}

fmi2Status fmi2EnterInitializationMode(fmi2Component c) { return c ? fmi2OK : fmi2Error; }
fmi2Status fmi2SetInteger(fmi2Component c, const fmi2ValueReference v[], size_t n, const fmi2Integer values[]) {
  return (void)v, (void)n, (void)values, fmi2EnterInitializationMode(c);
}
fmi2Status fmi2SetReal(fmi2Component c, const fmi2ValueReference v[], size_t n, const fmi2Real values[]) {
  return (void)v, (void)n, (void)values, fmi2EnterInitializationMode(c);
}
