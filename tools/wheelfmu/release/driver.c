/* The C driver of the FMU. As a program, `driver LIBRARY GUID`, it prints a hash of the bits of each scene's
   trajectory, the same source for every platform. The reports load it as a library and time its functions
   (lab/reports/native.py). The paper's equations are not here. */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "fmu.h"

/* Value references by name, as modelDescription.xml has them. */
enum {
#define STORED(name, reference, ...) ref_##name = reference,
#define COMPUTED(name, reference, ...) ref_##name = reference,
#include "variables.inc"
};
/* All outputs: of each calculated variable by its role and type. */
#define output_real(reference) reference,
#define local_real(reference)
#define local_integer(reference)
static const fmi2ValueReference outputs[] = {
#define STORED(...)
#define COMPUTED(name, reference, type, role) role##_##type(reference)
#include "variables.inc"
};
enum { output_count = sizeof outputs / sizeof *outputs };

static const fmi2ValueReference choices[] = {ref_formulation, ref_friction_law, ref_method},
                                reals[] = {ref_s, ref_J_y, ref_r, ref_psi_dot_start, ref_M_3, ref_mu_max, ref_mu_slide},
                                switches[] = {ref_keep_contact, ref_guided}, force = ref_F_X,
                                heading_rate = ref_psi_dot_guide;
static const struct scene {
  const char* name;
  int choices[3];
  double reals[7], slope, tolerance; /* slope in time: of F_X, N/s; of a guided wheel of psi_dot_guide, rad/s2 */
  int guided;
} scenes[] = {
    {"free", {1, 1, 1}, {0, 0.9, 0.05, 0, 0}, 0, 1e-8},
    {"friction", {1, 1, 1}, {0.03, 0.9, 0.05, 0, 0}, 0, 1e-8},
    {"free, multibody", {3, 1, 1}, {0, 0.9, 0.05, 0, 0}, 0, 1e-8},
    {"friction, multibody", {3, 1, 1}, {0.03, 0.9, 0.05, 0, 0}, 0, 1e-8},
    {"general inertia", {1, 1, 1}, {0, 1.1, 0.05, 0, 0}, 0, 1e-8},
    {"regularized friction, bdf", {1, 2, 3}, {0.03, 0.9, 0.05, 0, 0}, 0, 1e-8},
    {"thin disc", {1, 1, 1}, {0, 0.9, 0, 1, 0}, 0, 1e-8},
    {"driven", {1, 1, 1}, {0, 0.9, 0.05, 0, 0.5}, 0, 1e-8},
    {"driven on a slope in time", {1, 1, 1}, {0.01, 0.9, 0.05, 0, 0.2}, 0.1, 1e-6},
    {"tight tolerance", {1, 1, 1}, {0, 0.9, 0.05, 0.5, 0}, 0, 1e-12},
    {"sliding", {1, 1, 1}, {0, 0.9, 0.05, 0, 0, 0.45, 0.4}, 0, 1e-8},
    {"sliding, stiff law", {1, 2, 1}, {0.3, 0.9, 0.05, 0, 0, 0.45, 0.4}, 0, 1e-8},
    {"steered", {1, 1, 1}, {0.01, 1.1, 0.05, 0, -2}, 0.05, 1e-8, 1},
    {"steered, sliding", {3, 1, 1}, {0.01, 0.9, 0.05, 0, -15, 0.3, 0.25}, 0.05, 1e-8, 1},
};

/* Steps of one instance; `table` has for each step the values of the inputs, then their derivatives of order 1 to
   `orders`. Seconds. */
typedef struct Run {
  const fmi2ValueReference *inputs, *outputs;
  size_t input_count, output_count;
  int orders;
  const double* table;
  double step;
  long steps;
} Run;

typedef struct Outcome {
  long steps; /* done with fmi2OK or a warning */
  double seconds;
} Outcome;

enum { most_inputs = 8 };
static Fmu fmu;

/* Since the program's first call. */
static double seconds(void) {
  static struct timespec first;
  struct timespec now;
  timespec_get(&now, TIME_UTC);
  if (!first.tv_sec) first = now;
  return (double)(now.tv_sec - first.tv_sec) + 1e-9 * (double)(now.tv_nsec - first.tv_nsec);
}

void load(const char* path) { fmu = fmu_of(path); }

/* One communication step: inputs in, doStep, outputs out. */
static fmi2Status communicate(fmi2Component c, const Run* run, long step, double* row) {
  const size_t count = run->input_count;
  fmi2Status status = fmi2OK;
  for (int order = 0; count && order <= run->orders && status <= fmi2Warning; ++order) {
    const double* values = run->table + count * ((size_t)step * (size_t)(run->orders + 1) + (size_t)order);
    fmi2Integer orders[most_inputs];
    for (size_t i = 0; i < count; ++i) orders[i] = order;
    status = order ? fmu.SetRealInputDerivatives(c, run->inputs, count, orders, values)
                   : fmu.SetReal(c, run->inputs, count, values);
  }
  if (status <= fmi2Warning) status = fmu.DoStep(c, (double)step * run->step, run->step, fmi2True);
  return status <= fmi2Warning ? fmu.GetReal(c, run->outputs, run->output_count, row) : status;
}

/* rows: the outputs after each step; paces: seconds of each step, the clock's own cost included, or null. */
Outcome march(fmi2Component c, const Run* run, double* rows, double* paces) {
  const double begin = seconds();
  Outcome done = {0, 0};
  for (; done.steps < run->steps; ++done.steps) {
    const double before = paces ? seconds() : begin;
    if (communicate(c, run, done.steps, rows + (size_t)done.steps * run->output_count) > fmi2Warning) break;
    if (paces) paces[done.steps] = seconds() - before;
  }
  done.seconds = seconds() - begin;
  return done;
}

/* Seconds of a call that does nothing. */
double empty_call(fmi2Component c, long calls) {
  const double begin = seconds();
  for (long i = 0; i < calls; ++i) fmu.GetReal(c, NULL, 0, NULL);
  return (seconds() - begin) / (double)calls;
}

static void quiet(fmi2ComponentEnvironment e, fmi2String n, fmi2Status status, fmi2String c, fmi2String m, ...) {
  (void)e, (void)n, (void)c;
  if (status > fmi2Warning) fprintf(stderr, "%s\n", m);
}

static fmi2Component start(const struct scene* scene, const char* guid) {
  static const fmi2CallbackFunctions functions = {quiet, calloc, free, NULL, NULL};
  const fmi2Component c = fmu.Instantiate("wheel", fmi2CoSimulation, guid, "", &functions, 0, 0);
  if (!c) exit(1);
  const fmi2Boolean switched[] = {fmi2True, scene->guided};
  const fmi2Status statuses[] = {fmu.SetupExperiment(c, 1, scene->tolerance, 0, 0, 0),
                                 fmu.SetReal(c, reals, sizeof reals / sizeof *reals, scene->reals),
                                 fmu.SetInteger(c, choices, sizeof choices / sizeof *choices, scene->choices),
                                 fmu.SetBoolean(c, switches, 2, switched),
                                 fmu.EnterInitializationMode(c),
                                 fmu.ExitInitializationMode(c)};
  for (size_t i = 0; i < sizeof statuses / sizeof *statuses; ++i)
    if (statuses[i] != fmi2OK) exit(1);
  return c;
}

/* Seconds to create, initialize and free an instance in one of the scenes below. */
double life(const char* guid, int scene) {
  const double begin = seconds();
  fmu.FreeInstance(start(scenes + scene, guid));
  return seconds() - begin;
}

/* FNV-1a over the bits of 500 rows, 0.02 s apart. */
static void print_hash(const struct scene* scene, const char* guid) {
  enum { steps = 500 };
  static double pushes[2 * steps], rows[steps * output_count];
  for (int i = 0; i < steps; ++i) pushes[2 * i] = scene->slope * 0.02 * i, pushes[2 * i + 1] = scene->slope;
  const fmi2ValueReference* input = scene->guided ? &heading_rate : &force;
  const Run run = {input, outputs, scene->slope != 0, output_count, 1, pushes, 0.02, steps};
  const fmi2Component c = start(scene, guid);
  if (march(c, &run, rows, NULL).steps < steps) exit(1);
  uint64_t hash = 0xcbf29ce484222325u;
  const unsigned char* bytes = (const unsigned char*)rows;
  for (size_t i = 0; i < sizeof rows; ++i) hash = (hash ^ bytes[i]) * 0x100000001b3u;
  printf("%s\t%016llx\n", scene->name, (unsigned long long)hash);
  fmu.FreeInstance(c);
}

int main(int count, char** arguments) {
  if (count < 3) return 2;
  load(arguments[1]);
  for (unsigned i = 0; i < sizeof scenes / sizeof *scenes; ++i) print_hash(scenes + i, arguments[2]);
  return 0;
}
