/* The exchange between components; exchange.h has it in words. The arithmetic is that of vehicles/master.py. */
#include "exchange.h"

#include <string.h>

/* Sets values (order 0) or derivatives of this order, one per output of the transfer. */
static void hand(const Transfer* t, fmi2Integer order, const double* values) {
  double chosen[max_signals];
  fmi2Integer orders[max_signals];
  for (int i = 0; i < t->sink_count; ++i) {
    const Sink* s = &t->sinks[i];
    for (int k = 0; k < s->count; ++k) chosen[k] = values[s->at[k]], orders[k] = order;
    const Component* to = s->component;
    const size_t n = (size_t)s->count;
    const fmi2Status status =
        order ? to->set_rates(to->instance, s->inputs, n, orders, chosen) : to->set(to->instance, s->inputs, n, chosen);
    if (status != fmi2OK) give_up("does not take an input", to->name);
  }
}

void exchange(Plan* plan, int with_rates) {
  fmi2Integer ones[max_signals];
  for (int i = 0; i < max_signals; ++i) ones[i] = 1;
  for (int i = 0; i < plan->transfer_count; ++i) {
    Transfer* t = &plan->transfers[i];
    t->source->get(t->source->instance, t->outputs, (size_t)t->count, t->value);
    hand(t, 0, t->value);
  }
  for (int i = 0; with_rates && i < plan->transfer_count; ++i) {
    Transfer* t = &plan->transfers[i];
    t->source->rates(t->source->instance, t->outputs, (size_t)t->count, ones, t->rate);
    hand(t, 1, t->rate);
  }
}

void predict(Plan* plan, double h, int first) {
  double second[max_signals];
  for (int i = 0; i < plan->transfer_count; ++i) {
    Transfer* t = &plan->transfers[i];
    for (int k = 0; k < t->count; ++k) second[k] = (t->rate[k] - t->begin_rate[k]) / h;
    if (!first) hand(t, 2, second);
    memcpy(t->begin_value, t->value, (size_t)t->count * sizeof *t->value);
    memcpy(t->begin_rate, t->rate, (size_t)t->count * sizeof *t->rate);
  }
}

void correct(Plan* plan, double h) {
  double second[max_signals], third[max_signals];
  for (int i = 0; i < plan->transfer_count; ++i) {
    const Transfer* t = &plan->transfers[i];
    const double *value = t->begin_value, *rate = t->begin_rate;
    for (int k = 0; k < t->count; ++k) {
      const double mean = (t->value[k] - value[k]) / h;
      second[k] = 2 * (3 * mean - 2 * rate[k] - t->rate[k]) / h;
      third[k] = 6 * (rate[k] + t->rate[k] - 2 * mean) / (h * h);
    }
    hand(t, 0, value);
    hand(t, 1, rate);
    hand(t, 2, second);
    hand(t, 3, third);
  }
}
