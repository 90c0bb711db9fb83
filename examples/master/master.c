/* A co-simulation master in C: master PLAN. plan.h has the plan.
 *
 * Parallel master with fixed steps, as vehicles/master.py: values held, first derivatives, or rollback. Prints the
 * table of recorded variables (`row`), which component ended the run and when if one did (`ended`), and medians over
 * all steps of the time in the FMUs' calls. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "exchange.h"

typedef struct Cost {
  double *steps, *of_component[max_components]; /* us, one per communication step */
} Cost;

static double microseconds(void) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return 1e6 * (double)now.tv_sec + 1e-3 * (double)now.tv_nsec;
}

static void initialize(Plan* plan) {
  for (int i = 0; i < plan->component_count; ++i)
    if (plan->components[i].enter(plan->components[i].instance) != fmi2OK)
      give_up("does not enter initialization mode", plan->components[i].name);
  exchange(plan, 0);
  for (int i = 0; i < plan->component_count; ++i)
    if (plan->components[i].exit(plan->components[i].instance) != fmi2OK)
      give_up("does not leave initialization mode", plan->components[i].name);
}

static void print_row(const Plan* plan, double t) {
  printf("row %.17g", t);
  for (int i = 0; i < plan->record_count; ++i) {
    const Record* r = &plan->records[i];
    double value;
    r->component->get(r->component->instance, &r->variable, 1, &value);
    printf(" %.17g", value);
  }
  printf("\n");
}

/* Takes or undoes a step of one component; 0 where it ended the run. */
typedef int Act(Component* c, double t, double h);

static int take(Component* c, double t, double h, fmi2Boolean for_good) {
  if (c->step(c->instance, t, h, for_good) == fmi2OK) return 1;
  double last = t;
  c->status(c->instance, fmi2LastSuccessfulTime, &last);
  printf("ended %s %.17g\n", c->name, last);
  return 0;
}

static int take_for_good(Component* c, double t, double h) { return take(c, t, h, fmi2True); }
static int take_again(Component* c, double t, double h) { return take(c, t, h, fmi2False); }
static int try_out(Component* c, double t, double h) {
  return c->keep(c->instance, &c->state) == fmi2OK && take(c, t, h, fmi2False);
}
static int undo(Component* c, double t, double h) {
  (void)t, (void)h;
  return c->restore(c->instance, c->state) == fmi2OK;
}

static int all(Plan* plan, Act* act, double t, double h, const Cost* cost, long i) {
  double last = microseconds();
  for (int k = 0; k < plan->component_count; ++k) {
    if (!act(&plan->components[k], t, h)) return 0;
    const double now = microseconds();
    cost->of_component[k][i] += now - last;
    last = now;
  }
  return 1;
}

static int step(Plan* plan, double t, double h, const Cost* cost, long i) {
  if (plan->exchange != rollback) return all(plan, take_for_good, t, h, cost, i);
  predict(plan, h, i == 0);
  if (!all(plan, try_out, t, h, cost, i)) return 0;
  exchange(plan, 1);
  if (!all(plan, undo, t, h, cost, i)) return 0;
  correct(plan, h);
  return all(plan, take_again, t, h, cost, i);
}

/* Returns the number of whole steps. */
static long run(Plan* plan, long count, const Cost* cost) {
  for (long i = 0; i <= count; ++i) {
    const double t = (double)i * plan->step, h = (double)(i + 1) * plan->step - t;
    double begin = microseconds();
    exchange(plan, plan->exchange != held);
    if (i % plan->every == 0) {
      const double before = microseconds();
      print_row(plan, t);
      begin += microseconds() - before;
    }
    if (i == count || !step(plan, t, h, cost, i)) return i;
    cost->steps[i] = microseconds() - begin;
  }
  return count;
}

static int ascending(const void* a, const void* b) {
  const double x = *(const double*)a, y = *(const double*)b;
  return (x > y) - (x < y);
}

static double median(double* x, long n) {
  qsort(x, (size_t)n, sizeof *x, ascending);
  return x[n / 2];
}

static void print_costs(const Plan* plan, long count, const Cost* cost) {
  double* rest = calloc((size_t)count, sizeof *rest);
  if (!rest) give_up("out of memory", "master");
  for (long i = 0; i < count; ++i) {
    rest[i] = cost->steps[i];
    for (int k = 0; k < plan->component_count; ++k) rest[i] -= cost->of_component[k][i];
  }
  printf("exchange %.4f us\n", median(rest, count));
  free(rest);
  for (int k = 0; k < plan->component_count; ++k)
    printf("step %s %.4f us\n", plan->components[k].name, median(cost->of_component[k], count));
  printf("total %.4f us\n", median(cost->steps, count));
}

int main(int argc, char** argv) {
  if (argc != 2) give_up("usage: master PLAN", argv[0]);
  Plan* plan = calloc(1, sizeof *plan);
  if (!plan) give_up("out of memory", argv[0]);
  plan_read(argv[1], plan);
  const long count = lround(plan->stop / plan->step);
  double* every = calloc((size_t)count * (size_t)(plan->component_count + 1), sizeof *every);
  if (!every) give_up("out of memory", argv[0]);
  Cost cost = {.steps = every};
  for (int k = 0; k < plan->component_count; ++k) cost.of_component[k] = every + (k + 1) * count;
  initialize(plan);
  const long done = run(plan, count, &cost);
  if (done) print_costs(plan, done, &cost);
  for (int k = 0; k < plan->component_count; ++k) component_free(&plan->components[k]);
  free(every);
  free(plan);
  return 0;
}
