/* Fails the n-th allocation of a process, for every n: malloc, calloc and realloc are wrapped in the FMU's library
   only. faults LIBRARY GUID: prints how many allocations were failed and what came of it; status 1 if a promise is
   broken.

   Promises: no crash, no leak (live blocks counted), fmi2Instantiate gives null, calls give fmi2Error with a sentence,
   and an instance whose call failed can be reset and run. */
#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fmi2FunctionTypes.h"

/* The program's own definitions win over libc's for the library too. */
extern void* __libc_malloc(size_t);
extern void* __libc_calloc(size_t, size_t);
extern void* __libc_realloc(void*, size_t);
extern void __libc_free(void*);

static int watching;
static long allocations, failing, live, messages;

static int fails(void) { return watching && ++allocations == failing; }

void* malloc(size_t size) {
  if (fails()) return NULL;
  live += watching;
  return __libc_malloc(size);
}
void* calloc(size_t n, size_t size) {
  if (fails()) return NULL;
  live += watching;
  return __libc_calloc(n, size);
}
void* realloc(void* old, size_t size) {
  if (fails()) return NULL;
  if (!old) live += watching;
  return __libc_realloc(old, size);
}
void free(void* block) {
  if (block) live -= watching;
  __libc_free(block);
}

static struct {
  fmi2InstantiateTYPE* instantiate;
  fmi2FreeInstanceTYPE* free;
  fmi2SetIntegerTYPE* set_integer;
  fmi2SetRealTYPE* set_real;
  fmi2EnterInitializationModeTYPE* enter;
  fmi2ExitInitializationModeTYPE* leave;
  fmi2DoStepTYPE* step;
  fmi2ResetTYPE* reset;
  fmi2GetFMUstateTYPE* get_state;
  fmi2SetFMUstateTYPE* set_state;
  fmi2FreeFMUstateTYPE* free_state;
  fmi2SerializedFMUstateSizeTYPE* size;
  fmi2SerializeFMUstateTYPE* serialize;
  fmi2DeSerializeFMUstateTYPE* deserialize;
} fmu;

static void receive(fmi2ComponentEnvironment e, fmi2String n, fmi2Status s, fmi2String c, fmi2String m, ...) {
  (void)e, (void)n, (void)s, (void)c, (void)m;
  ++messages;
}

static void broken(const char* promise) {
  watching = 0;
  fprintf(stderr, "Failing allocation %ld: %s\n", failing, promise);
  exit(1);
}

/* OK, or an error that was told. */
static int went_well(fmi2Status status, long told) {
  if (status == fmi2Error && messages == told) broken("an error without a sentence");
  if (status != fmi2OK && status != fmi2Error) broken("neither OK nor Error");
  return status == fmi2OK;
}
#define TRY(call) (told = messages, went_well(call, told))

static int run(fmi2Component c, const int* choices) {
  static const fmi2ValueReference integers[] = {16, 17, 19}, s = 7;
  const double friction = 0.03;
  long told;
  if (!TRY(fmu.set_integer(c, integers, 3, choices)) || !TRY(fmu.set_real(c, &s, 1, &friction))) return 0;
  if (!TRY(fmu.enter(c)) || !TRY(fmu.leave(c))) return 0;
  for (int k = 0; k < 20; ++k)
    if (!TRY(fmu.step(c, 0.1 * k, 0.1, fmi2True))) return 0;
  return 1;
}

static int roll_back(fmi2Component c) {
  static char bytes[16384];
  fmi2FMUstate state = NULL, copy = NULL;
  size_t size = 0;
  long told;
  const int fine = TRY(fmu.get_state(c, &state)) && TRY(fmu.size(c, state, &size)) &&
                   TRY(fmu.serialize(c, state, bytes, size)) && TRY(fmu.deserialize(c, bytes, size, &copy)) &&
                   TRY(fmu.step(c, 2.0, 0.1, fmi2True)) && TRY(fmu.set_state(c, copy)) &&
                   TRY(fmu.step(c, 2.0, 0.1, fmi2True));
  fmu.free_state(c, &state);
  fmu.free_state(c, &copy);
  return fine;
}

/* One life with the n-th allocation failing; 1 if nothing failed any more. */
static int live_once(const char* guid, const int* choices) {
  static const fmi2CallbackFunctions functions = {receive, NULL, NULL, NULL, NULL};
  allocations = live = messages = 0;
  watching = 1;
  const fmi2Component c = fmu.instantiate("wheel", fmi2CoSimulation, guid, "", &functions, 0, 0);
  if (!c && !messages) broken("no instance and no sentence");
  if (c) {
    const int fine = run(c, choices) && roll_back(c);
    if (!fine && (fmu.reset(c) != fmi2OK || !run(c, choices))) broken("a reset instance does not run");
    fmu.free(c);
  }
  watching = 0;
  if (live) broken("memory has leaked");
  return allocations < failing;
}

static void load(const char* path) {
  void* library = dlopen(path, RTLD_NOW | RTLD_LOCAL);
  if (!library) {
    fprintf(stderr, "%s\n", dlerror());
    exit(2);
  }
  static const char* const names[] = {"fmi2Instantiate",
                                      "fmi2FreeInstance",
                                      "fmi2SetInteger",
                                      "fmi2SetReal",
                                      "fmi2EnterInitializationMode",
                                      "fmi2ExitInitializationMode",
                                      "fmi2DoStep",
                                      "fmi2Reset",
                                      "fmi2GetFMUstate",
                                      "fmi2SetFMUstate",
                                      "fmi2FreeFMUstate",
                                      "fmi2SerializedFMUstateSize",
                                      "fmi2SerializeFMUstate",
                                      "fmi2DeSerializeFMUstate"};
  void* pointers[sizeof names / sizeof *names];
  for (unsigned i = 0; i < sizeof names / sizeof *names; ++i) pointers[i] = dlsym(library, names[i]);
  memcpy(&fmu, pointers, sizeof fmu);
}

int main(int count, char** arguments) {
  static const int scenes[][3] = {{1, 1, 1}, {3, 1, 1}, {1, 2, 3}, {3, 2, 3}}; /* formulation, friction law, method */
  if (count < 3) return 2;
  load(arguments[1]);
  for (unsigned k = 0; k < sizeof scenes / sizeof *scenes; ++k) {
    for (failing = 1; !live_once(arguments[2], scenes[k]); ++failing) {
    }
    printf("%ld allocations failed one by one\n", failing - 1);
  }
  return 0;
}
