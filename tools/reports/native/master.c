/* A small co-simulation master, called from Python (reports/native.py): runs a scene in the library of the FMU and says
 * what it took. Times are wall-clock seconds. No paper equation, no frame; value references and start values come from
 * the caller. */
#include <malloc.h>
#include <time.h>

#include "fmu.h"

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
  Fmu* fmu = malloc(sizeof *fmu);
  *fmu = fmu_of(path);
  return fmu;
}

static void log_message(fmi2ComponentEnvironment environment, fmi2String instance, fmi2Status status,
                        fmi2String category, fmi2String message, ...) {
  (void)environment, (void)instance, (void)status, (void)category, (void)message;
}

static fmi2Status set_start(const Fmu* fmu, fmi2Component instance, const Start* start) {
  const int whole = (int)start->value;
  if (start->kind == 'r') return fmu->SetReal(instance, &start->variable, 1, &start->value);
  if (start->kind == 'i') return fmu->SetInteger(instance, &start->variable, 1, &whole);
  return fmu->SetBoolean(instance, &start->variable, 1, &whole);
}

/* Instantiated, start values set, initialized. Null on failure. */
static fmi2Component start_instance(const Fmu* fmu, const Run* run) {
  static const fmi2CallbackFunctions callbacks = {log_message, calloc, free, NULL, NULL};
  fmi2Component instance = fmu->Instantiate("wheel", fmi2CoSimulation, run->guid, "file:///none", &callbacks, 0, 0);
  if (!instance) return NULL;
  fmi2Status worst = fmu->SetupExperiment(instance, run->tolerance > 0, run->tolerance, 0, 0, 0);
  for (int i = 0; i < run->start_count && worst <= fmi2Warning; ++i) worst = set_start(fmu, instance, &run->starts[i]);
  if (worst <= fmi2Warning) worst = fmu->EnterInitializationMode(instance);
  if (worst <= fmi2Warning) worst = fmu->ExitInitializationMode(instance);
  if (worst <= fmi2Warning) return instance;
  fmu->FreeInstance(instance);
  return NULL;
}

static fmi2Status feed(const Fmu* fmu, const Run* run, fmi2Component instance, long step) {
  if (!run->table) return fmi2OK;
  const size_t count = (size_t)run->input_count;
  const double* row = run->table + (size_t)step * count * (size_t)(run->orders + 1);
  fmi2Status status = fmu->SetReal(instance, run->inputs, count, row);
  for (int order = 1; order <= run->orders && status <= fmi2Warning; ++order) {
    fmi2Integer orders[MOST_INPUTS];
    for (size_t i = 0; i < count; ++i) orders[i] = order;
    status = fmu->SetRealInputDerivatives(instance, run->inputs, count, orders, row + count * (size_t)order);
  }
  return status;
}

/* One communication step: inputs in, doStep, outputs out. */
static fmi2Status communicate(const Fmu* fmu, const Run* run, fmi2Component instance, long step, double* row) {
  fmi2Status status = feed(fmu, run, instance, step);
  if (status <= fmi2Warning) status = fmu->DoStep(instance, (double)step * run->step, run->step, fmi2True);
  if (status <= fmi2Warning && run->output_count)
    status = fmu->GetReal(instance, run->outputs, (size_t)run->output_count, row);
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
  if (run->output_count) fmu->GetReal(instance, run->outputs, (size_t)run->output_count, rows ? rows : unread);
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
  if (counters) fmu->GetInteger(instance, run->counters, (size_t)run->counter_count, counters);
  const double t_3 = now();
  fmu->FreeInstance(instance);
  cost[0] = t_1 - t_0, cost[1] = t_2 - t_1, cost[2] = now() - t_3;
  return outcome;
}
