/* The built FMU as a master sees it: the shared library out of wheel.fmu, its functions, one instance.
 *
 * No paper equation, no frame. Value references come from the caller, who read them in modelDescription.xml. */
#ifndef BENCH_FMU_H
#define BENCH_FMU_H

#include <stddef.h>

#include "fmi2FunctionTypes.h"

typedef struct Fmu {
  fmi2InstantiateTYPE* instantiate;
  fmi2FreeInstanceTYPE* free_instance;
  fmi2SetupExperimentTYPE* setup_experiment;
  fmi2EnterInitializationModeTYPE* enter_initialization;
  fmi2ExitInitializationModeTYPE* exit_initialization;
  fmi2SetRealTYPE* set_real;
  fmi2SetIntegerTYPE* set_integer;
  fmi2SetBooleanTYPE* set_boolean;
  fmi2GetRealTYPE* get_real;
  fmi2GetIntegerTYPE* get_integer;
  fmi2DoStepTYPE* do_step;
} Fmu;

enum { MOST_STARTS = 32, MOST_READ = 16 };

/* A start value: kind is 'r', 'i' or 'b' (Real, Integer, Boolean). */
typedef struct Start {
  char kind;
  fmi2ValueReference variable;
  double value;
} Start;

/* One run as the command line asks for it. Seconds; tolerance <= 0: the FMU's default. */
typedef struct Run {
  const char *library, *guid;
  Start starts[MOST_STARTS];
  int start_count;
  fmi2ValueReference outputs[MOST_READ]; /* Real, read after each step */
  size_t output_count;
  fmi2ValueReference counters[MOST_READ]; /* Integer, read once at the end */
  size_t counter_count;
  double tolerance, step, stop;
  long jump_variable; /* >= 0: this Real is set before each step, to jump_value and twice that in turn */
  double jump_value;
  double seconds;   /* time to spend on repetitions */
  long repetitions; /* > 0: exactly so many */
  long instances;
  int print_rows;
} Run;

/* Ends the program with a sentence on failure. */
Fmu load_fmu(const char* library);

/* Instantiated, start values set, initialized: ready for the first step. Null on failure. */
fmi2Component start_instance(const Fmu* fmu, const Run* run);

/* Wall clock, s. */
double now(void);

/* Time this process has had of the processor, s. */
double processor_time(void);

#endif
