/* Runs ten scenes in one FMU library and prints a hash of every trajectory's bits: driver LIBRARY GUID.
   The same source for every platform; the paper's equations are not here. */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fmi2FunctionTypes.h"
#include "load_library.h"

#ifdef __wasi__
#include "fmi2Functions.h"
static void* find_symbol(void* library, const char* name) {
#define LINKED(function)         \
  {                              \
    #function, (void*)(function) \
  }
  static const struct {
    const char* name;
    void* function;
  } functions[] = {
      LINKED(fmi2Instantiate),
      LINKED(fmi2FreeInstance),
      LINKED(fmi2SetupExperiment),
      LINKED(fmi2EnterInitializationMode),
      LINKED(fmi2ExitInitializationMode),
      LINKED(fmi2SetReal),
      LINKED(fmi2SetInteger),
      LINKED(fmi2SetBoolean),
      LINKED(fmi2GetReal),
      LINKED(fmi2DoStep),
      LINKED(fmi2SetRealInputDerivatives),
  };
  (void)library;
  for (unsigned i = 0; i < sizeof functions / sizeof *functions; ++i)
    if (strcmp(name, functions[i].name) == 0) return functions[i].function;
  return NULL;
}
#endif

/* Value references by name, as modelDescription.xml has them. */
enum {
#define STORED(name, ...) ref_##name,
#define COMPUTED(name, ...) ref_##name,
#include "variables.inc"
#undef STORED
#undef COMPUTED
};
enum { first_output = ref_X_O, output_count = ref_E - ref_X_O };

struct scene {
  const char* name;
  int choices[3]; /* formulation, friction law, method */
  double s, J_y, r, rate, M_3, slope, tolerance;
};

static const struct scene scenes[] = {
    {"free", {1, 1, 1}, 0, 0.9, 0.05, 0, 0, 0, 1e-8},
    {"friction", {1, 1, 1}, 0.03, 0.9, 0.05, 0, 0, 0, 1e-8},
    {"free, multibody", {3, 1, 1}, 0, 0.9, 0.05, 0, 0, 0, 1e-8},
    {"friction, multibody", {3, 1, 1}, 0.03, 0.9, 0.05, 0, 0, 0, 1e-8},
    {"general inertia", {1, 1, 1}, 0, 1.1, 0.05, 0, 0, 0, 1e-8},
    {"regularized friction, bdf", {1, 2, 3}, 0.03, 0.9, 0.05, 0, 0, 0, 1e-8},
    {"thin disc", {1, 1, 1}, 0, 0.9, 0, 1, 0, 0, 1e-8},
    {"driven", {1, 1, 1}, 0, 0.9, 0.05, 0, 0.5, 0, 1e-8},
    {"driven on a slope in time", {1, 1, 1}, 0.01, 0.9, 0.05, 0, 0.2, 0.1, 1e-6},
    {"tight tolerance", {1, 1, 1}, 0, 0.9, 0.05, 0.5, 0, 0, 1e-12},
};

static void* library;

static void* need(const char* name) {
  void* f = find_symbol(library, name);
  if (!f) {
    fprintf(stderr, "%s is missing\n", name);
    exit(1);
  }
  return f;
}

static void quiet(fmi2ComponentEnvironment e, fmi2String n, fmi2Status status, fmi2String c, fmi2String m, ...) {
  (void)e, (void)n, (void)c;
  if (status > fmi2Warning) fprintf(stderr, "%s\n", m);
}

static uint64_t hash_of(uint64_t hash, const void* data, size_t size) {
  const unsigned char* bytes = data;
  for (size_t i = 0; i < size; ++i) hash = (hash ^ bytes[i]) * 0x100000001b3u;
  return hash;
}

static fmi2Component start(const struct scene* scene, const char* guid) {
  static const fmi2CallbackFunctions functions = {quiet, calloc, free, NULL, NULL};
  const fmi2Component c =
      ((fmi2InstantiateTYPE*)need("fmi2Instantiate"))("wheel", fmi2CoSimulation, guid, "", &functions, 0, 0);
  if (!c) exit(1);
  const fmi2ValueReference reals[] = {ref_s, ref_J_y, ref_r, ref_psi_dot_start},
                           whole[] = {ref_formulation, ref_friction_law, ref_method};
  const fmi2ValueReference contact = ref_keep_contact, torque = ref_M_3;
  const double values[] = {scene->s, scene->J_y, scene->r, scene->rate};
  const fmi2Boolean kept = fmi2True;
  ((fmi2SetupExperimentTYPE*)need("fmi2SetupExperiment"))(c, 1, scene->tolerance, 0, 0, 0);
  ((fmi2SetRealTYPE*)need("fmi2SetReal"))(c, reals, 4, values);
  ((fmi2SetRealTYPE*)need("fmi2SetReal"))(c, &torque, 1, &scene->M_3);
  ((fmi2SetIntegerTYPE*)need("fmi2SetInteger"))(c, whole, 3, scene->choices);
  ((fmi2SetBooleanTYPE*)need("fmi2SetBoolean"))(c, &contact, 1, &kept);
  ((fmi2EnterInitializationModeTYPE*)need("fmi2EnterInitializationMode"))(c);
  if (((fmi2ExitInitializationModeTYPE*)need("fmi2ExitInitializationMode"))(c) != fmi2OK) exit(1);
  return c;
}

static void run(const struct scene* scene, const char* guid) {
  fmi2DoStepTYPE* step = (fmi2DoStepTYPE*)need("fmi2DoStep");
  fmi2GetRealTYPE* get = (fmi2GetRealTYPE*)need("fmi2GetReal");
  fmi2SetRealInputDerivativesTYPE* derive = (fmi2SetRealInputDerivativesTYPE*)need("fmi2SetRealInputDerivatives");
  fmi2ValueReference outputs[output_count];
  const fmi2ValueReference force = ref_F_X;
  const fmi2Integer order = 1;
  double values[output_count] = {0};
  uint64_t hash = 0xcbf29ce484222325u;
  const fmi2Component c = start(scene, guid);
  for (unsigned i = 0; i < output_count; ++i) outputs[i] = first_output + i;
  const int steps = 500; /* of 0.02 s */
  for (int k = 0; k < steps; ++k) {
    if (scene->slope != 0) derive(c, &force, 1, &order, &scene->slope);
    if (step(c, 0.02 * k, 0.02, fmi2True) != fmi2OK) break;
    get(c, outputs, output_count, values);
    hash = hash_of(hash, values, sizeof values);
  }
  printf("%s\t%016llx", scene->name, (unsigned long long)hash);
  for (int i = 0; i < 4; ++i) printf("\t%.17g", values[i]);
  printf("\n");
  ((fmi2FreeInstanceTYPE*)need("fmi2FreeInstance"))(c);
}

int main(int count, char** arguments) {
  if (count < 3) return 2;
  library = open_library(arguments[1]);
  if (!library) {
    fprintf(stderr, "%s could not be loaded\n", arguments[1]);
    return 1;
  }
  for (unsigned i = 0; i < sizeof scenes / sizeof *scenes; ++i) run(scenes + i, arguments[2]);
  return 0;
}
