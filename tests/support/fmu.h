/* The functions of the FMU that the C programs call, by FMI's names without "fmi2". No paper equation, no frame. */
#ifndef SUPPORT_FMU_H
#define SUPPORT_FMU_H

#include "fmi2FunctionTypes.h"
#ifdef __wasi__ /* no libraries to open: the program has the wheel linked in */
#include "fmi2Functions.h"
#else
#include "load_library.h"
#endif

/* clang-format off */
#define FMU_FUNCTIONS(F) \
  F(Instantiate) F(FreeInstance) F(SetDebugLogging) F(SetupExperiment) F(EnterInitializationMode) \
  F(ExitInitializationMode) F(Terminate) F(Reset) F(SetReal) F(SetInteger) F(SetBoolean) F(GetReal) F(GetInteger) \
  F(DoStep) F(CancelStep) F(GetRealStatus) F(GetBooleanStatus) F(SetRealInputDerivatives) F(GetRealOutputDerivatives) \
  F(GetDirectionalDerivative) F(GetFMUstate) F(SetFMUstate) F(FreeFMUstate) F(SerializedFMUstateSize) \
  F(SerializeFMUstate) F(DeSerializeFMUstate)
/* clang-format on */

typedef struct Fmu {
#define MEMBER(name) fmi2##name##TYPE* name;
  FMU_FUNCTIONS(MEMBER)
#undef MEMBER
} Fmu;

/* Out of the library at `path`. Ends the program with a sentence where it or a function is missing. */
static inline Fmu fmu_of(const char* path) {
#ifdef __wasi__
#define LINKED(name) .name = fmi2##name,
  (void)path;
  return (Fmu){FMU_FUNCTIONS(LINKED)};
#undef LINKED
#else
#define NAME(name) "fmi2" #name,
  static const char* const names[] = {FMU_FUNCTIONS(NAME)};
#undef NAME
  Fmu fmu;
  load_functions(path, names, sizeof names / sizeof *names, &fmu);
  return fmu;
#endif
}

#endif
