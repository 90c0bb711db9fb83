/* A life: begun, initialized with start values of its own, then sixty calls drawn from all kinds, then terminated. */
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "threads.h"

/* Value references by name, as modelDescription.xml has them. */
enum {
#define STORED(name, ...) ref_##name,
#define COMPUTED(name, ...) ref_##name,
#include "variables.inc"
#undef STORED
#undef COMPUTED
};
enum { CALLS = 60, OUTPUTS = ref_theta_ddot - ref_X_O, INPUTS = ref_X_O - ref_F_X, STATE_SIZE = 1 << 17 };

struct Life {
  const Fmu* fmu;
  fmi2Component component;
  unsigned long number;
  unsigned long long dice, sum;
  double t;
  int calls_left;
  fmi2FMUstate kept;
  double kept_t;
};

static atomic_ulong calls;

unsigned long calls_made(void) { return atomic_load(&calls); }
unsigned long number_of(const Life* life) { return life->number; }

unsigned long long draw(unsigned long long* dice) {
  *dice ^= *dice << 13u;
  *dice ^= *dice >> 7u;
  *dice ^= *dice << 17u;
  return *dice >> 11u;
}

/* In [-1, 1]. */
static double draw_unit(Life* life) { return (double)(draw(&life->dice) % 2001) * 1e-3 - 1; }

static void add(Life* life, const void* data, size_t size) {
  const unsigned char* bytes = data;
  for (size_t i = 0; i < size; ++i) life->sum = (life->sum ^ bytes[i]) * 0x100000001b3u;
}

/* The environment is the life: a message that reaches the wrong one changes two sums. */
static void receive(fmi2ComponentEnvironment life, fmi2String name, fmi2Status status, fmi2String category,
                    fmi2String message, ...) {
  (void)name, (void)status, (void)category;
  add(life, message, strlen(message));
}

static void must(Life* life, fmi2Status status, const char* call) {
  atomic_fetch_add(&calls, 1);
  add(life, &status, sizeof status);
  if (status <= fmi2Warning) return;
  fprintf(stderr, "Instance %lu: %s gave status %d.\n", life->number, call, status);
  exit(1);
}
#define MUST(function, ...) must(life, life->fmu->function(life->component, __VA_ARGS__), #function)
#define MUST_BARE(function) must(life, life->fmu->function(life->component), #function)

static void read_outputs(Life* life) {
  fmi2ValueReference outputs[OUTPUTS], counters[] = {ref_n_steps, ref_n_rhs, ref_n_events};
  fmi2Integer ones[OUTPUTS], whole[3];
  double values[OUTPUTS];
  for (unsigned i = 0; i < OUTPUTS; ++i) outputs[i] = ref_X_O + i, ones[i] = 1;
  MUST(GetReal, outputs, OUTPUTS, values);
  add(life, values, sizeof values);
  MUST(GetInteger, counters, 3, whole);
  add(life, whole, sizeof whole);
  if (life->t <= 0) return;
  MUST(GetRealOutputDerivatives, outputs, OUTPUTS, ones, values);
  add(life, values, sizeof values);
}

static void step(Life* life) {
  const double h = 0.01 * (1 + draw_unit(life) * 0.9);
  MUST(DoStep, life->t, h, fmi2True);
  MUST(GetRealStatus, fmi2LastSuccessfulTime, &life->t);
  add(life, &life->t, sizeof life->t);
}

static void push(Life* life) {
  const fmi2ValueReference input = ref_F_X + (unsigned)(draw(&life->dice) % INPUTS), s = ref_s;
  const int brakes = input == ref_M_brake; /* a brake is never negative */
  const double force = brakes ? 2 : 5 * draw_unit(life), slope = brakes ? 0 : 10 * draw_unit(life),
               friction = 0.02 * (1 + draw_unit(life));
  const fmi2Integer first = 1;
  MUST(SetReal, &input, 1, &force);
  if (draw(&life->dice) % 2) MUST(SetRealInputDerivatives, &input, 1, &first, &slope);
  if (draw(&life->dice) % 4 == 0) MUST(SetReal, &s, 1, &friction);
}

static void keep_state(Life* life) {
  MUST(GetFMUstate, &life->kept);
  life->kept_t = life->t;
}

static void roll_back(Life* life) {
  if (!life->kept) return;
  MUST(SetFMUstate, life->kept);
  life->t = life->kept_t;
}

static void move_state(Life* life) {
  fmi2Byte bytes[STATE_SIZE];
  fmi2FMUstate copy = NULL;
  size_t size = 0;
  keep_state(life);
  MUST(SerializedFMUstateSize, life->kept, &size);
  MUST(SerializeFMUstate, life->kept, bytes, size);
  add(life, bytes, size);
  MUST(DeSerializeFMUstate, bytes, size, &copy);
  MUST(SetFMUstate, copy);
  MUST(FreeFMUstate, &copy);
}

static void ask(Life* life) {
  const fmi2ValueReference lambda_3 = ref_lambda_3, F_Z = ref_F_Z;
  const double seed = 1;
  double slope = 0;
  fmi2Boolean ended = fmi2True;
  MUST(GetDirectionalDerivative, &lambda_3, 1, &F_Z, 1, &seed, &slope);
  MUST(GetBooleanStatus, fmi2Terminated, &ended);
  add(life, &slope, sizeof slope);
}

/* An illegal call that talks, and a switch of the log. */
static void talk(Life* life) {
  const fmi2Boolean on = draw(&life->dice) % 2 ? fmi2True : fmi2False;
  MUST(SetDebugLogging, on, 0, NULL);
  const fmi2Status refused = life->fmu->CancelStep(life->component);
  add(life, &refused, sizeof refused);
}

static void initialize(Life* life) {
  const fmi2ValueReference reals[] = {ref_s, ref_J_y, ref_Y_O_start, ref_phi_dot_start},
                           choices[] = {ref_formulation, ref_friction_law, ref_method}, keep = ref_keep_contact;
  const int other = life->number % 3 == 1;
  const double values[] = {life->number % 2 ? 0.02 : 0.0, other ? 1.1 : 0.9, 1e-3 * (double)life->number, -2.5};
  const fmi2Integer picked[] = {1, life->number % 5 == 3 ? 2 : 1, life->number % 7 == 3 ? 3 : 1};
  const fmi2Boolean yes = fmi2True;
  life->t = 0;
  MUST(SetReal, reals, 4, values);
  MUST(SetInteger, choices, 3, picked);
  MUST(SetBoolean, &keep, 1, &yes);
  MUST(SetupExperiment, fmi2True, 1e-6, 0, fmi2False, 0);
  MUST_BARE(EnterInitializationMode);
  read_outputs(life);
  MUST_BARE(ExitInitializationMode);
}

static void begin_again(Life* life) {
  MUST_BARE(Reset);
  initialize(life);
}

Life* begin_life(const Fmu* fmu, const char* guid, unsigned long number) {
  Life* life = calloc(1, sizeof *life);
  const fmi2CallbackFunctions callbacks = {receive, NULL, NULL, NULL, life};
  *life = (Life){.fmu = fmu, .number = number, .dice = 0x2545f4914f6cdd1du * (number + 1), .calls_left = CALLS};
  life->component = fmu->Instantiate("wheel", fmi2CoSimulation, guid, "", &callbacks, fmi2False, fmi2True);
  if (!life->component) {
    fprintf(stderr, "Instance %lu was refused.\n", number);
    exit(1);
  }
  initialize(life);
  return life;
}

int go_on(Life* life) {
  static void (*const kinds[])(Life*) = {step, step,       step,      step,       read_outputs, read_outputs,
                                         push, keep_state, roll_back, move_state, ask,          talk};
  const unsigned long long choice = draw(&life->dice) % 100;
  if (choice == 99)
    begin_again(life);
  else
    kinds[choice % (sizeof kinds / sizeof *kinds)](life);
  return --life->calls_left > 0;
}

unsigned long long end_life(Life* life) {
  read_outputs(life);
  MUST_BARE(Terminate);
  if (life->kept) MUST(FreeFMUstate, &life->kept);
  life->fmu->FreeInstance(life->component);
  const unsigned long long sum = life->sum;
  free(life);
  return sum;
}
