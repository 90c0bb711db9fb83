/* One FMU in the C master: its library, its functions, its instance. POSIX. */
#ifndef COMPONENT_H
#define COMPONENT_H

#include "fmi2FunctionTypes.h"

typedef struct Component {
  char name[64];
  fmi2Component instance;
  fmi2FMUstate state; /* the snapshot, kept from step to step */
  fmi2CallbackFunctions callbacks;
  fmi2InstantiateTYPE* instantiate;
  fmi2SetupExperimentTYPE* setup;
  fmi2EnterInitializationModeTYPE* enter;
  fmi2ExitInitializationModeTYPE* exit;
  fmi2GetRealTYPE* get;
  fmi2SetRealTYPE* set;
  fmi2GetRealOutputDerivativesTYPE* rates;
  fmi2SetRealInputDerivativesTYPE* set_rates;
  fmi2DoStepTYPE* step;
  fmi2GetRealStatusTYPE* status;
  fmi2GetFMUstateTYPE* keep;
  fmi2SetFMUstateTYPE* restore;
  fmi2FreeFMUstateTYPE* forget;
  fmi2TerminateTYPE* terminate;
  fmi2FreeInstanceTYPE* release;
} Component;

/* Says it and ends the program. */
_Noreturn void give_up(const char* what, const char* of);
void component_load(Component* c, const char* name, const char* library, const char* guid);
void component_free(Component* c);

#endif
