/* A small co-simulation master, called from Python (reports/native.py): runs a scene in the library out of wheel.fmu,
 * again and again, and says what it took. Times are wall-clock seconds. No paper equation, no frame; value references
 * and start values come from the caller. */
#include <malloc.h>
#include <pthread.h>
#include <string.h>
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

static Outcome go(const Fmu* fmu, const Run* run, fmi2Component instance, double* rows) {
  Outcome outcome = {fmi2OK, 0};
  double unread[MOST_OUTPUTS];
  if (run->output_count) fmu->get_real(instance, run->outputs, (size_t)run->output_count, rows ? rows : unread);
  while (outcome.steps < run->steps) {
    double* row = rows ? rows + (outcome.steps + 1) * run->output_count : unread;
    outcome.status = communicate(fmu, run, instance, outcome.steps, row);
    if (outcome.status > fmi2Warning) break;
    ++outcome.steps;
  }
  return outcome;
}

/* One run apart from the clock. rows: (steps + 1) x outputs, the first at the start; counters: at the end. */
Outcome solve(const Fmu* fmu, const Run* run, double* rows, int* counters) {
  fmi2Component instance = start_instance(fmu, run);
  if (!instance) return (Outcome){fmi2Error, 0};
  const Outcome outcome = go(fmu, run, instance, rows);
  fmu->get_integer(instance, run->counters, (size_t)run->counter_count, counters);
  fmu->free_instance(instance);
  return outcome;
}

/* Runs for `seconds`, at least once and at most `most` times: times[0] to times[2] are start, run and end of the first,
 * and so on. Returns the number of runs. */
long measure(const Fmu* fmu, const Run* run, double seconds, long most, double* times) {
  const double begin = now();
  long count = 0;
  while (count < most && (count == 0 || now() - begin < seconds)) {
    const double t_0 = now();
    fmi2Component instance = start_instance(fmu, run);
    const double t_1 = now();
    if (!instance) return 0;
    go(fmu, run, instance, NULL);
    const double t_2 = now();
    fmu->free_instance(instance);
    double* row = times + 3 * count++;
    row[0] = t_1 - t_0, row[1] = t_2 - t_1, row[2] = now() - t_2;
  }
  return count;
}

/* The time of each single communication step, the clock's own cost included. */
Outcome pace(const Fmu* fmu, const Run* run, double* times) {
  Outcome outcome = {fmi2Error, 0};
  double unread[MOST_OUTPUTS];
  fmi2Component instance = start_instance(fmu, run);
  if (!instance) return outcome;
  for (outcome.status = fmi2OK; outcome.steps < run->steps; ++outcome.steps) {
    const double before = now();
    outcome.status = communicate(fmu, run, instance, outcome.steps, unread);
    times[outcome.steps] = now() - before;
    if (outcome.status > fmi2Warning) break;
  }
  fmu->free_instance(instance);
  return outcome;
}

typedef struct Crowd {
  const Fmu* fmu;
  const Run* run;
  fmi2Component* instances;
  long first, last; /* instances [first, last) */
} Crowd;

/* One step of each instance, then the next step of each: neighbours alternate as in a co-simulation. */
static void* step_in_turn(void* data) {
  const Crowd* crowd = data;
  double unread[MOST_OUTPUTS];
  for (long k = 0; k < crowd->run->steps; ++k)
    for (long i = crowd->first; i < crowd->last; ++i)
      communicate(crowd->fmu, crowd->run, crowd->instances[i], k, unread);
  return NULL;
}

static double bytes_in_use(void) {
  const struct mallinfo2 info = mallinfo2();
  return (double)(info.uordblks + info.hblkhd);
}

/* `count` instances in one process, half of them stepped by a second thread. Out, per instance: bytes, seconds to
 * create and initialize, to step, to free. Returns how many ended with other bits than `alone`, the outputs of one by
 * itself; -1 where one could not be started. */
long run_crowd(const Fmu* fmu, const Run* run, long count, const double* alone, double* out) {
  const size_t width = (size_t)run->output_count;
  fmi2Component* instances = calloc((size_t)count, sizeof *instances);
  const double bytes = bytes_in_use(), t_0 = now();
  for (long i = 0; i < count; ++i)
    if (!(instances[i] = start_instance(fmu, run))) return -1;
  const double t_1 = now();
  Crowd halves[2] = {{fmu, run, instances, 0, count / 2}, {fmu, run, instances, count / 2, count}};
  pthread_t other;
  pthread_create(&other, NULL, step_in_turn, &halves[0]);
  step_in_turn(&halves[1]);
  pthread_join(other, NULL);
  const double t_2 = now();
  out[0] = (bytes_in_use() - bytes) / (double)count;
  long different = 0;
  for (long i = 0; i < count; ++i) {
    double row[MOST_OUTPUTS] = {0};
    fmu->get_real(instances[i], run->outputs, width, row);
    different += memcmp(row, alone, width * sizeof *row) != 0;
  }
  const double t_3 = now();
  for (long i = 0; i < count; ++i) fmu->free_instance(instances[i]);
  out[1] = (t_1 - t_0) / (double)count, out[2] = (t_2 - t_1) / (double)count, out[3] = (now() - t_3) / (double)count;
  free(instances);
  return different;
}
