/* One instance's life as a sequence of calls that its number alone decides, and the FMU that it is lived in. */
#ifndef THREADS_H
#define THREADS_H

#include "fmi2FunctionTypes.h"

typedef struct Fmu {
  fmi2InstantiateTYPE* instantiate;
  fmi2FreeInstanceTYPE* free_instance;
  fmi2SetDebugLoggingTYPE* set_debug_logging;
  fmi2SetupExperimentTYPE* setup_experiment;
  fmi2EnterInitializationModeTYPE* enter_initialization;
  fmi2ExitInitializationModeTYPE* exit_initialization;
  fmi2TerminateTYPE* terminate;
  fmi2ResetTYPE* reset;
  fmi2SetRealTYPE* set_real;
  fmi2SetIntegerTYPE* set_integer;
  fmi2SetBooleanTYPE* set_boolean;
  fmi2GetRealTYPE* get_real;
  fmi2GetIntegerTYPE* get_integer;
  fmi2DoStepTYPE* do_step;
  fmi2GetRealStatusTYPE* get_real_status;
  fmi2GetBooleanStatusTYPE* get_boolean_status;
  fmi2SetRealInputDerivativesTYPE* set_input_derivatives;
  fmi2GetRealOutputDerivativesTYPE* get_output_derivatives;
  fmi2GetDirectionalDerivativeTYPE* directional_derivative;
  fmi2GetFMUstateTYPE* get_state;
  fmi2SetFMUstateTYPE* set_state;
  fmi2FreeFMUstateTYPE* free_state;
  fmi2SerializedFMUstateSizeTYPE* state_size;
  fmi2SerializeFMUstateTYPE* serialize;
  fmi2DeSerializeFMUstateTYPE* deserialize;
  fmi2CancelStepTYPE* cancel_step;
} Fmu;

/* Ends the program with a sentence on failure. */
Fmu load_fmu(const char* library);

typedef struct Life Life;
Life* begin_life(const Fmu* fmu, const char* guid, unsigned long number);
/* One more call; 0 where the life is over. */
int go_on(Life* life);
unsigned long number_of(const Life* life);
/* Frees it; the checksum of all outputs, derivatives, states and messages it has seen. */
unsigned long long end_life(Life* life);

unsigned long calls_made(void);

/* Next number of a xorshift sequence. */
unsigned long long draw(unsigned long long* dice);

#endif
