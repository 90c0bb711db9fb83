/* A small co-simulation master, called from Python (reports/native.py): runs a scene in the library of the FMU and says
 * what it took. Times are wall-clock seconds. No paper equation, no frame; value references and start values come from
 * the caller. */
#include <malloc.h>
#include <time.h>

#include "fmi2FunctionTypes.h"
#include "load_library.h"

typedef struct Fmu {
  fmi2InstantiateTYPE* instantiate;
  fmi2FreeInstanceTYPE* free_instance;
  fmi2SetupExperimentTYPE* setup_experiment;
  fmi2EnterInitializationModeTYPE* enter_initialization;
  fmi2ExitInitializationModeTYPE* exit_initialization;
  fmi2SetRealTYPE* set_real;
  fmi2SetIntegerTYPE* set_integer;
  fmi2SetBooleanTYPE* set_boolean;
  fmi2SetRealInputDerivativesTYPE* set_input_derivatives;
  fmi2GetRealTYPE* get_real;
  fmi2GetIntegerTYPE* get_integer;
  fmi2DoStepTYPE* do_step;
} Fmu;

/* A start value; kind: 'r', 'i' or 'b' (Real, Integer, Boolean). */
typedef struct Start {
  int kind;
  fmi2ValueReference variable;
  double value;
} Start;

/* One run. Seconds; tolerance <= 0: the FMU's default. `table` has for each step the values of the inputs, then their
 * derivatives of order 1 to `orders`; null: no input is set. */
typedef struct Run {
  const char* guid;
  const Start* starts;
  int start_count;
  const fmi2ValueReference *outputs, *counters, *inputs;
  int output_count, counter_count, input_count, orders;
  const double* table;
  double tolerance, step;
  long steps;
} Run;

typedef struct Outcome {
  int status;
  long steps; /* done with fmi2OK or a warning */
} Outcome;

enum { MOST_INPUTS = 8, MOST_ORDERS = 3, MOST_OUTPUTS = 32 };

static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

Fmu* load_fmu(const char* path) {
  static const char* const names[] = {"fmi2Instantiate",
                                      "fmi2FreeInstance",
                                      "fmi2SetupExperiment",
                                      "fmi2EnterInitializationMode",
                                      "fmi2ExitInitializationMode",
                                      "fmi2SetReal",
                                      "fmi2SetInteger",
                                      "fmi2SetBoolean",
                                      "fmi2SetRealInputDerivatives",
                                      "fmi2GetReal",
                                      "fmi2GetInteger",
                                      "fmi2DoStep"};
  Fmu* fmu = malloc(sizeof *fmu);
  _Static_assert(sizeof names / sizeof *names == sizeof *fmu / sizeof(void*), "one name per function");
  load_functions(path, names, sizeof names / sizeof *names, fmu);
  return fmu;
}

static void log_message(fmi2ComponentEnvironment environment, fmi2String instance, fmi2Status status,
                        fmi2String category, fmi2String message, ...) {
  (void)environment, (void)instance, (void)status, (void)category, (void)message;
}

static fmi2Status set_start(const Fmu* fmu, fmi2Component instance, const Start* start) {
  const int whole = (int)start->value;
  if (start->kind == 'r') return fmu->set_real(instance, &start->variable, 1, &start->value);
  if (start->kind == 'i') return fmu->set_integer(instance, &start->variable, 1, &whole);
  return fmu->set_boolean(instance, &start->variable, 1, &whole);
}

/* Instantiated, start values set, initialized. Null on failure. */
static fmi2Component start_instance(const Fmu* fmu, const Run* run) {
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

static fmi2Status feed(const Fmu* fmu, const Run* run, fmi2Component instance, long step) {
  if (!run->table) return fmi2OK;
  const size_t count = (size_t)run->input_count;
  const double* row = run->table + (size_t)step * count * (size_t)(run->orders + 1);
  fmi2Status status = fmu->set_real(instance, run->inputs, count, row);
  for (int order = 1; order <= run->orders && status <= fmi2Warning; ++order) {
    fmi2Integer orders[MOST_INPUTS];
    for (size_t i = 0; i < count; ++i) orders[i] = order;
    status = fmu->set_input_derivatives(instance, run->inputs, count, orders, row + count * (size_t)order);
  }
  return status;
}

/* One communication step: inputs in, doStep, outputs out. */
static fmi2Status communicate(const Fmu* fmu, const Run* run, fmi2Component instance, long step, double* row) {
  fmi2Status status = feed(fmu, run, instance, step);
  if (status <= fmi2Warning) status = fmu->do_step(instance, (double)step * run->step, run->step, fmi2True);
  if (status <= fmi2Warning && run->output_count)
    status = fmu->get_real(instance, run->outputs, (size_t)run->output_count, row);
  return status;
}

static double bytes_in_use(void) {
  const struct mallinfo2 info = mallinfo2();
  return (double)(info.uordblks + info.hblkhd);
}

/* One run. Out, where not null: rows, (steps + 1) x outputs, the first at the start; paces, seconds of each step, the
 * clock's own cost included; counters at the end. cost: seconds to create and initialize, to step, to free; bytes. */
Outcome solve(const Fmu* fmu, const Run* run, double* rows, double* paces, int* counters, double* cost) {
  Outcome outcome = {fmi2Error, 0};
  double unread[MOST_OUTPUTS];
  const double bytes = bytes_in_use(), t_0 = now();
  fmi2Component instance = start_instance(fmu, run);
  const double t_1 = now();
  if (!instance) return outcome;
  outcome.status = fmi2OK;
  if (run->output_count) fmu->get_real(instance, run->outputs, (size_t)run->output_count, rows ? rows : unread);
  while (outcome.steps < run->steps) {
    double* row = rows ? rows + (outcome.steps + 1) * run->output_count : unread;
    const double before = paces ? now() : 0;
    outcome.status = communicate(fmu, run, instance, outcome.steps, row);
    if (paces) paces[outcome.steps] = now() - before;
    if (outcome.status > fmi2Warning) break;
    ++outcome.steps;
  }
  const double t_2 = now();
  cost[3] = bytes_in_use() - bytes;
  if (counters) fmu->get_integer(instance, run->counters, (size_t)run->counter_count, counters);
  const double t_3 = now();
  fmu->free_instance(instance);
  cost[0] = t_1 - t_0, cost[1] = t_2 - t_1, cost[2] = now() - t_3;
  return outcome;
}
