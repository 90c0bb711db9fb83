/* The functions of the library, by name. */
#include "unit.h"

#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* As the members of Unit. */
static const char* const names[] = {"fmi2Instantiate",
                                    "fmi2FreeInstance",
                                    "fmi2SetInteger",
                                    "fmi2SetReal",
                                    "fmi2GetReal",
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
enum { COUNT = sizeof names / sizeof *names };

Unit load_unit(const char* path) {
  Unit unit;
  void* pointers[COUNT];
  void* library = dlopen(path, RTLD_NOW | RTLD_LOCAL);
  for (int i = 0; library && i < COUNT; ++i) pointers[i] = dlsym(library, names[i]);
  for (int i = 0; i < COUNT; ++i) {
    if (library && pointers[i]) continue;
    fprintf(stderr, "%s: %s\n", path, dlerror());
    exit(2);
  }
  memcpy(&unit, pointers, sizeof unit);
  return unit;
}
