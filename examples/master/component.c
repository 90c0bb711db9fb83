/* Loading of an FMU's library and its instance. */
#include "component.h"

#include <dlfcn.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void give_up(const char* what, const char* of) {
  fprintf(stderr, "%s: %s\n", of, what);
  exit(1);
}

static void logger(fmi2ComponentEnvironment environment, fmi2String name, fmi2Status status, fmi2String category,
                   fmi2String text, ...) {
  (void)environment, (void)category;
  va_list more;
  va_start(more, text);
  fprintf(stderr, "%s (status %d): ", name, (int)status);
  vfprintf(stderr, text, more);
  fputc('\n', stderr);
  va_end(more);
}

static void* function(void* library, const char* name) {
  void* found = dlsym(library, name);
  if (!found) give_up("the library lacks this function", name);
  return found;
}

void component_load(Component* c, const char* name, const char* library, const char* guid) {
  void* handle = dlopen(library, RTLD_NOW | RTLD_LOCAL);
  if (!handle) give_up(dlerror(), name);
  snprintf(c->name, sizeof c->name, "%s", name);
  c->callbacks = (fmi2CallbackFunctions){logger, calloc, free, NULL, NULL};
  *(void**)&c->instantiate = function(handle, "fmi2Instantiate");
  *(void**)&c->setup = function(handle, "fmi2SetupExperiment");
  *(void**)&c->enter = function(handle, "fmi2EnterInitializationMode");
  *(void**)&c->exit = function(handle, "fmi2ExitInitializationMode");
  *(void**)&c->get = function(handle, "fmi2GetReal");
  *(void**)&c->set = function(handle, "fmi2SetReal");
  *(void**)&c->rates = function(handle, "fmi2GetRealOutputDerivatives");
  *(void**)&c->set_rates = function(handle, "fmi2SetRealInputDerivatives");
  *(void**)&c->step = function(handle, "fmi2DoStep");
  *(void**)&c->status = function(handle, "fmi2GetRealStatus");
  *(void**)&c->keep = function(handle, "fmi2GetFMUstate");
  *(void**)&c->restore = function(handle, "fmi2SetFMUstate");
  *(void**)&c->forget = function(handle, "fmi2FreeFMUstate");
  *(void**)&c->terminate = function(handle, "fmi2Terminate");
  *(void**)&c->release = function(handle, "fmi2FreeInstance");
  c->instance = c->instantiate(c->name, fmi2CoSimulation, guid, NULL, &c->callbacks, fmi2False, fmi2False);
  if (!c->instance) give_up("fmi2Instantiate gave no instance", name);
  c->setup(c->instance, fmi2False, 0, 0, fmi2False, 0);
}

void component_free(Component* c) {
  c->forget(c->instance, &c->state);
  c->terminate(c->instance);
  c->release(c->instance);
}
