/* Loading wheel.fmu's library and starting an instance. No paper equation, no frame. */
#include "fmu.h"

#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

static double read_clock(clockid_t clock) {
  struct timespec t;
  clock_gettime(clock, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

double now(void) { return read_clock(CLOCK_MONOTONIC); }
double processor_time(void) { return read_clock(CLOCK_PROCESS_CPUTIME_ID); }

static void find(void* library, const char* name, void* function) {
  void* symbol = dlsym(library, name);
  if (!symbol) {
    fprintf(stderr, "%s is missing: %s\n", name, dlerror());
    exit(2);
  }
  *(void**)function = symbol;
}

Fmu load_fmu(const char* library) {
  Fmu fmu;
  void* handle = dlopen(library, RTLD_NOW | RTLD_LOCAL);
  if (!handle) {
    fprintf(stderr, "%s\n", dlerror());
    exit(2);
  }
  find(handle, "fmi2Instantiate", &fmu.instantiate);
  find(handle, "fmi2FreeInstance", &fmu.free_instance);
  find(handle, "fmi2SetupExperiment", &fmu.setup_experiment);
  find(handle, "fmi2EnterInitializationMode", &fmu.enter_initialization);
  find(handle, "fmi2ExitInitializationMode", &fmu.exit_initialization);
  find(handle, "fmi2SetReal", &fmu.set_real);
  find(handle, "fmi2SetInteger", &fmu.set_integer);
  find(handle, "fmi2SetBoolean", &fmu.set_boolean);
  find(handle, "fmi2GetReal", &fmu.get_real);
  find(handle, "fmi2GetInteger", &fmu.get_integer);
  find(handle, "fmi2DoStep", &fmu.do_step);
  return fmu;
}

static void log_message(fmi2ComponentEnvironment environment, fmi2String instance, fmi2Status status,
                        fmi2String category, fmi2String message, ...) {
  (void)environment, (void)instance, (void)category;
  if (status > fmi2Warning) fprintf(stderr, "%s\n", message);
}

static fmi2Status set_start(const Fmu* fmu, fmi2Component instance, const Start* start) {
  const fmi2Integer integer = (fmi2Integer)start->value;
  if (start->kind == 'r') return fmu->set_real(instance, &start->variable, 1, &start->value);
  if (start->kind == 'i') return fmu->set_integer(instance, &start->variable, 1, &integer);
  const fmi2Boolean boolean = start->value != 0;
  return fmu->set_boolean(instance, &start->variable, 1, &boolean);
}

fmi2Component start_instance(const Fmu* fmu, const Run* run) {
  static const fmi2CallbackFunctions callbacks = {log_message, calloc, free, NULL, NULL};
  fmi2Component instance = fmu->instantiate("wheel", fmi2CoSimulation, run->guid, "file:///none", &callbacks, 0, 0);
  if (!instance) return NULL;
  fmi2Status worst = fmu->setup_experiment(instance, run->tolerance > 0, run->tolerance, 0, 0, 0);
  for (int i = 0; i < run->start_count && worst <= fmi2Warning; ++i) worst = set_start(fmu, instance, &run->starts[i]);
  if (worst <= fmi2Warning) worst = fmu->enter_initialization(instance);
  if (worst <= fmi2Warning) worst = fmu->exit_initialization(instance);
  if (worst <= fmi2Warning) return instance;
  fmu->free_instance(instance);
  return NULL;
}
