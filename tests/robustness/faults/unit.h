/* The library under test, loaded; and what a run of it left behind. No paper equation, no frame. */
#ifndef FAULTS_UNIT_H
#define FAULTS_UNIT_H

#include "fmi2FunctionTypes.h"

typedef struct Unit {
  fmi2InstantiateTYPE* instantiate;
  fmi2FreeInstanceTYPE* free;
  fmi2SetIntegerTYPE* set_integer;
  fmi2SetRealTYPE* set_real;
  fmi2GetRealTYPE* get_real;
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
} Unit;

/* Ends the program with a sentence on failure. */
Unit load_unit(const char* path);

#endif
