/* The functions of the library, by name. */
#include "unit.h"

#include "load_library.h"

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
  _Static_assert(sizeof unit == COUNT * sizeof(void*), "one name per function");
  load_functions(path, names, COUNT, &unit);
  return unit;
}
