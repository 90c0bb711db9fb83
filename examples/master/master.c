/* A co-simulation master in C, for what a step costs: master PLAN. plan.h has the plan.
 *
 * Parallel master with fixed steps, as vehicles/master.py: values, and first derivatives if the plan says so. Prints
 * the recorded variables at the end, and medians over all steps of the time in the FMUs' calls. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "plan.h"

typedef struct Cost {
  double *exchange, *steps, *of_component[max_components]; /* us, one per communication step */
} Cost;

static double microseconds(void) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return 1e6 * (double)now.tv_sec + 1e-3 * (double)now.tv_nsec;
}

static void hand_over(const Transfer* t, int derivatives) {
  static fmi2Integer ones[max_signals];
  for (int i = 0; !ones[max_signals - 1] && i < max_signals; ++i) ones[i] = 1;
  double values[max_signals], chosen[max_signals];
  const Component* c = t->source;
  if (derivatives)
    c->rates(c->instance, t->outputs, (size_t)t->count, ones, values);
  else
    c->get(c->instance, t->outputs, (size_t)t->count, values);
  for (int i = 0; i < t->sink_count; ++i) {
    const Sink* s = &t->sinks[i];
    for (int k = 0; k < s->count; ++k) chosen[k] = values[s->at[k]];
    const Component* to = s->component;
    const fmi2Status status = derivatives ? to->set_rates(to->instance, s->inputs, (size_t)s->count, ones, chosen)
                                          : to->set(to->instance, s->inputs, (size_t)s->count, chosen);
    if (status != fmi2OK) give_up("does not take an input", to->name);
  }
}

static void exchange(const Plan* plan, int derivatives) {
  for (int i = 0; i < plan->transfer_count; ++i) hand_over(&plan->transfers[i], 0);
  for (int i = 0; derivatives && i < plan->transfer_count; ++i) hand_over(&plan->transfers[i], 1);
}

static void initialize(const Plan* plan) {
  for (int i = 0; i < plan->component_count; ++i)
    if (plan->components[i].enter(plan->components[i].instance) != fmi2OK)
      give_up("does not enter initialization mode", plan->components[i].name);
  exchange(plan, 0);
  for (int i = 0; i < plan->component_count; ++i)
    if (plan->components[i].exit(plan->components[i].instance) != fmi2OK)
      give_up("does not leave initialization mode", plan->components[i].name);
}

static void run(const Plan* plan, long count, Cost* cost) {
  for (long i = 0; i < count; ++i) {
    const double t = (double)i * plan->step, h = (double)(i + 1) * plan->step - t, begin = microseconds();
    exchange(plan, plan->derivatives);
    double last = microseconds();
    cost->exchange[i] = last - begin;
    for (int k = 0; k < plan->component_count; ++k) {
      const Component* c = &plan->components[k];
      if (c->step(c->instance, t, h, fmi2True) != fmi2OK) give_up("ended the run", c->name);
      const double now = microseconds();
      cost->of_component[k][i] = now - last;
      last = now;
    }
    cost->steps[i] = last - begin;
  }
  exchange(plan, plan->derivatives);
}

static int ascending(const void* a, const void* b) {
  const double x = *(const double*)a, y = *(const double*)b;
  return (x > y) - (x < y);
}

static double median(double* x, long n) {
  qsort(x, (size_t)n, sizeof *x, ascending);
  return x[n / 2];
}

static void print(const Plan* plan, long count, Cost* cost) {
  for (int i = 0; i < plan->record_count; ++i) {
    const Record* r = &plan->records[i];
    double value;
    r->component->get(r->component->instance, &r->variable, 1, &value);
    printf("record %s %u %.17g\n", r->component->name, r->variable, value);
  }
  printf("exchange %.4f us\n", median(cost->exchange, count));
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
  double* all = calloc((size_t)count * (size_t)(plan->component_count + 2), sizeof *all);
  if (!all) give_up("out of memory", argv[0]);
  Cost cost = {.exchange = all, .steps = all + count};
  for (int k = 0; k < plan->component_count; ++k) cost.of_component[k] = all + (k + 2) * count;
  initialize(plan);
  run(plan, count, &cost);
  print(plan, count, &cost);
  for (int k = 0; k < plan->component_count; ++k) {
    plan->components[k].terminate(plan->components[k].instance);
    plan->components[k].release(plan->components[k].instance);
  }
  free(all);
  free(plan);
  return 0;
}
