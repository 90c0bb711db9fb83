/* Runs ten scenes in one FMU library and prints a hash of every trajectory's bits: driver LIBRARY GUID.
   The same source for every platform; the paper's equations are not here. */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include "fmu.h"

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

static void quiet(fmi2ComponentEnvironment e, fmi2String n, fmi2Status status, fmi2String c, fmi2String m, ...) {
  (void)e, (void)n, (void)c;
  if (status > fmi2Warning) fprintf(stderr, "%s\n", m);
}

static uint64_t hash_of(uint64_t hash, const void* data, size_t size) {
  const unsigned char* bytes = data;
  for (size_t i = 0; i < size; ++i) hash = (hash ^ bytes[i]) * 0x100000001b3u;
  return hash;
}

static fmi2Component start(const Fmu* fmu, const struct scene* scene, const char* guid) {
  static const fmi2CallbackFunctions functions = {quiet, calloc, free, NULL, NULL};
  const fmi2Component c = fmu->Instantiate("wheel", fmi2CoSimulation, guid, "", &functions, 0, 0);
  if (!c) exit(1);
  const fmi2ValueReference reals[] = {ref_s, ref_J_y, ref_r, ref_psi_dot_start, ref_M_3},
                           whole[] = {ref_formulation, ref_friction_law, ref_method}, contact = ref_keep_contact;
  const double values[] = {scene->s, scene->J_y, scene->r, scene->rate, scene->M_3};
  const fmi2Boolean kept = fmi2True;
  fmu->SetupExperiment(c, 1, scene->tolerance, 0, 0, 0);
  fmu->SetReal(c, reals, 5, values);
  fmu->SetInteger(c, whole, 3, scene->choices);
  fmu->SetBoolean(c, &contact, 1, &kept);
  fmu->EnterInitializationMode(c);
  if (fmu->ExitInitializationMode(c) != fmi2OK) exit(1);
  return c;
}

static void run(const Fmu* fmu, const struct scene* scene, const char* guid) {
  fmi2ValueReference outputs[output_count];
  const fmi2ValueReference force = ref_F_X;
  const fmi2Integer order = 1;
  double values[output_count] = {0};
  uint64_t hash = 0xcbf29ce484222325u;
  const fmi2Component c = start(fmu, scene, guid);
  for (unsigned i = 0; i < output_count; ++i) outputs[i] = first_output + i;
  const int steps = 500; /* of 0.02 s */
  for (int k = 0; k < steps; ++k) {
    if (scene->slope != 0) fmu->SetRealInputDerivatives(c, &force, 1, &order, &scene->slope);
    if (fmu->DoStep(c, 0.02 * k, 0.02, fmi2True) != fmi2OK) break;
    fmu->GetReal(c, outputs, output_count, values);
    hash = hash_of(hash, values, sizeof values);
  }
  printf("%s\t%016llx\n", scene->name, (unsigned long long)hash);
  fmu->FreeInstance(c);
}

int main(int count, char** arguments) {
  if (count < 3) return 2;
  const Fmu fmu = fmu_of(arguments[1]);
  for (unsigned i = 0; i < sizeof scenes / sizeof *scenes; ++i) run(&fmu, scenes + i, arguments[2]);
  return 0;
}
