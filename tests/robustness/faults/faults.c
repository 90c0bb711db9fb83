/* Lives of one instance in which memory runs short: at each allocation in turn, once or from there on.
 *
 *   faults LIBRARY GUID FORMULATION LAW METHOD COMPANIONS SECONDS
 *
 * Companions are instances made before it; SECONDS are allowed for all. Prints as JSON what was counted. Status 1 and a
 * sentence if a promise is broken: no crash, no hang, no leak; fmi2Instantiate gives null, other calls fmi2Error, with
 * a sentence; once there is memory again, the same instance and a new one go on with the bits of an undisturbed life.
 * No paper equation. */
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "memory.h"
#include "unit.h"

enum { STEPS = 30, OUTPUTS = 4, ROWS = STEPS + 4, MOST_COMPANIONS = 16 };

typedef struct Life {
  double rows[ROWS][OUTPUTS];
  int count;
} Life;

/* Value references by name, as modelDescription.xml has them. */
enum {
#define STORED(name, ...) ref_##name,
#define COMPUTED(name, ...) ref_##name,
#include "variables.inc"
#undef STORED
#undef COMPUTED
};

static Unit unit;
static const char* guid;
static int choices[3]; /* formulation, friction law, method */
static int companions;
static long sentences;
static long taken_by_start, taken_by_run, taken_by_snapshots;

static void receive(fmi2ComponentEnvironment e, fmi2String n, fmi2Status s, fmi2String c, fmi2String m, ...) {
  (void)e, (void)n, (void)c;
  sentences += s == fmi2Error && m && *m;
}

static void require(int kept, const char* broken) {
  if (kept) return;
  const long number = memory.fail_first, last = memory.fail_last;
  memory.watched = 0;
  fprintf(stderr, "allocation %ld failing%s: %s\n", number, last > number ? " and all later ones" : "", broken);
  exit(1);
}

/* Whether a call went well; if not, it must have said so. */
static int check(fmi2Status status, long sentences_before) {
  require(status == fmi2OK || status == fmi2Error, "a call returned neither OK nor Error");
  require(status == fmi2OK || sentences > sentences_before, "an error without a sentence");
  return status == fmi2OK;
}
#define WELL(call) (before = sentences, check(call, before))

static int step(fmi2Component c, int k, Life* life) {
  static const fmi2ValueReference outputs[OUTPUTS] = {ref_X_O, ref_theta, ref_phi_dot, ref_psi_dot};
  long before;
  if (!WELL(unit.step(c, 0.1 * k, 0.1, fmi2True))) return 0;
  return WELL(unit.get_real(c, outputs, OUTPUTS, life->rows[life->count++]));
}

/* From instantiated; passes sticks and releases. */
static int run(fmi2Component c, Life* life) {
  static const fmi2ValueReference integers[] = {ref_formulation, ref_friction_law, ref_method}, s = ref_s;
  const double friction = 0.3;
  long before;
  life->count = 0;
  if (!WELL(unit.set_integer(c, integers, 3, choices)) || !WELL(unit.set_real(c, &s, 1, &friction))) return 0;
  if (!WELL(unit.enter(c)) || !WELL(unit.leave(c))) return 0;
  for (int k = 0; k < STEPS; ++k)
    if (!step(c, k, life)) return 0;
  return 1;
}

/* A step, back by a copy out of bytes, and the same step again. */
static int roll_back(fmi2Component c, Life* life) {
  static char bytes[1 << 17];
  fmi2FMUstate state = NULL, copy = NULL;
  size_t size = 0;
  long before;
  life->count = STEPS;
  const int well = WELL(unit.get_state(c, &state)) && WELL(unit.size(c, state, &size)) && size <= sizeof bytes &&
                   WELL(unit.serialize(c, state, bytes, size)) && WELL(unit.deserialize(c, bytes, size, &copy)) &&
                   WELL(unit.get_state(c, &state)) && step(c, STEPS, life) && WELL(unit.set_state(c, copy)) &&
                   step(c, STEPS, life);
  unit.free_state(c, &state);
  unit.free_state(c, &copy);
  return well;
}

static void same_bits(const Life* life, const Life* undisturbed) {
  if (!undisturbed) return;
  require(life->count == undisturbed->count, "a life took another number of steps");
  require(memcmp(life->rows, undisturbed->rows, sizeof life->rows[0] * (size_t)life->count) == 0, "other bits");
}

static fmi2Component begin(void) {
  static const fmi2CallbackFunctions functions = {receive, NULL, NULL, NULL, NULL};
  const long before = sentences;
  const fmi2Component c = unit.instantiate("wheel", fmi2CoSimulation, guid, "", &functions, 0, 0);
  if (c) return c;
  require(sentences > before, "no instance and no sentence");
  const fmi2Component mute = unit.instantiate("wheel", fmi2CoSimulation, guid, "", NULL, 0, 0);
  if (mute) unit.free(mute);
  return NULL;
}

static long taken_since(long before) { return memory.taken - before; }

/* Where a call fails for want of memory, there is memory again afterwards. */
static void go_through(fmi2Component c, Life* life, const Life* undisturbed) {
  const long before_run = memory.taken;
  if (!run(c, life)) {
    memory.fail_last = 0;
    require(unit.reset(c) == fmi2OK && run(c, life), "a reset instance does not run");
  }
  const long before_snapshots = memory.taken;
  if (!roll_back(c, life)) {
    memory.fail_last = 0;
    require(roll_back(c, life), "no snapshot although there is memory again");
  }
  same_bits(life, undisturbed);
  taken_by_run = before_snapshots - before_run;
  taken_by_snapshots = taken_since(before_snapshots);
  memory.fail_last = 0;
  require(unit.reset(c) == fmi2OK && run(c, life) && roll_back(c, life), "a reset instance does not run");
  same_bits(life, undisturbed);
}

/* Returns how many allocations failed. */
static long live(unsigned char fill, long first, long last, Life* life, const Life* undisturbed) {
  fmi2Component beside[MOST_COMPANIONS];
  for (int i = 0; i < companions; ++i)
    beside[i] = unit.instantiate("companion", fmi2CoSimulation, guid, "", NULL, 0, 0);
  watch(fill, first, last);
  const fmi2Component c = begin();
  taken_by_start = memory.taken;
  if (c) {
    go_through(c, life, undisturbed);
    unit.free(c);
  }
  memory.watched = 0;
  require(memory.live == 0, "memory has leaked");
  for (int i = 0; i < companions; ++i) unit.free(beside[i]);
  return memory.failed;
}

/* Each allocation in turn; after each disturbed life an undisturbed one. Returns how many lives were disturbed. */
static long disturb(int for_good, const Life* undisturbed) {
  Life life;
  for (long n = 1;; ++n) {
    if (!live(0x5a, n, for_good ? LONG_MAX : n, &life, undisturbed)) return n - 1;
    live(0xff, 0, 0, &life, undisturbed);
  }
}

int main(int count, char** arguments) {
  static Life undisturbed, life;
  if (count != 8) return 2;
  alarm((unsigned)atoi(arguments[7]));
  unit = load_unit(arguments[1]);
  guid = arguments[2];
  for (int i = 0; i < 3; ++i) choices[i] = atoi(arguments[3 + i]);
  companions = atoi(arguments[6]);
  if (companions > MOST_COMPANIONS) return 2;
  live(0xa5, 0, 0, &undisturbed, NULL);
  live(0x00, 0, 0, &life, &undisturbed);
  live(0xa5, 0, 0, &life, &undisturbed);
  printf("{\"start\": %ld, \"run\": %ld, \"snapshots\": %ld, ", taken_by_start, taken_by_run, taken_by_snapshots);
  printf("\"bytes\": %zu, \"unused\": %zu, ", memory.largest, memory.largest_unused);
  const long once = disturb(0, &undisturbed), for_good = disturb(1, &undisturbed);
  printf("\"failed_once\": %ld, \"failed_for_good\": %ld}\n", once, for_good);
  return 0;
}
