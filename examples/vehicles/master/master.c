/* Exchange and steps; master.h explains them. */
#include "master.h"

#include <string.h>
#include <time.h>

static int allowed(Master* m, int component, fmi2Status status) {
  if (status > fmi2Warning) m->refused = component;
  return status <= fmi2Warning;
}

static fmi2Status call(const Component* c, const Transfer* t, fmi2Integer order, double* numbers) {
  const size_t n = (size_t)t->count;
  fmi2Integer orders[n];
  for (size_t k = 0; k < n; ++k) orders[k] = order;
  if (t->reads)
    return order ? c->fmi2GetRealOutputDerivatives(c->instance, t->variables, n, orders, numbers)
                 : c->fmi2GetReal(c->instance, t->variables, n, numbers);
  return order ? c->fmi2SetRealInputDerivatives(c->instance, t->variables, n, orders, numbers)
               : c->fmi2SetReal(c->instance, t->variables, n, numbers);
}

/* All transfers in turn, of values (order 0) or derivatives of this order; reads: outputs too, else inputs are set to
 * the signals as they are. */
static int transfer(Master* m, fmi2Integer order, int reads, double* signals) {
  double numbers[m->signals];
  for (int i = 0; i < m->transfers; ++i) {
    const Transfer* t = &m->transfer[i];
    if (t->reads && !reads) continue;
    for (int k = 0; k < t->count; ++k) numbers[k] = signals[t->signals[k]];
    if (!allowed(m, t->component, call(&m->component[t->component], t, order, numbers))) return 0;
    for (int k = 0; k < t->count; ++k) signals[t->signals[k]] = numbers[k];
  }
  return 1;
}

int master_exchange(Master* m, int with_rates) {
  return transfer(m, 0, 1, m->value) && (!with_rates || transfer(m, 1, 1, m->rate));
}

/* Before the first trial of a step with rollback: second derivatives, guessed from the last step's rates. */
static int predict(Master* m, double h, int first) {
  const size_t size = (size_t)m->signals * sizeof *m->value;
  for (int k = 0; k < m->signals; ++k) m->second[k] = (m->rate[k] - m->begin_rate[k]) / h;
  memcpy(m->begin_value, m->value, size);
  memcpy(m->begin_rate, m->rate, size);
  return first || transfer(m, 2, 0, m->second);
}

/* After it, with all components set back: the values of the step's begin, and the cubics. */
static int correct(Master* m, double h) {
  for (int k = 0; k < m->signals; ++k) {
    const double mean = (m->value[k] - m->begin_value[k]) / h, begin = m->begin_rate[k], end = m->rate[k];
    m->second[k] = 2 * (3 * mean - 2 * begin - end) / h;
    m->third[k] = 6 * (begin + end - 2 * mean) / (h * h);
  }
  return transfer(m, 0, 0, m->begin_value) && transfer(m, 1, 0, m->begin_rate) && transfer(m, 2, 0, m->second) &&
         transfer(m, 3, 0, m->third);
}

/* Since some full million of seconds: the whole time since 1970 would leave a double a quarter of a microsecond. */
static double microseconds(void) {
  struct timespec now;
  timespec_get(&now, TIME_UTC);
  return 1e6 * (double)(now.tv_sec % 1000000) + 1e-3 * (double)now.tv_nsec;
}

/* What is done to each component in turn. */
typedef enum Act { try_out, undo, take_again, take_for_good } Act;

static fmi2Status act_on(Component* c, Act act, double t, double h) {
  if (act == undo) return c->fmi2SetFMUstate(c->instance, c->state);
  const fmi2Status kept = act == try_out ? c->fmi2GetFMUstate(c->instance, &c->state) : fmi2OK;
  return kept == fmi2OK ? c->fmi2DoStep(c->instance, t, h, act == take_for_good) : kept;
}

static int all(Master* m, Act act, double t, double h, double* cost) {
  double last = microseconds();
  for (int k = 0; k < m->components; ++k) {
    if (!allowed(m, k, act_on(&m->component[k], act, t, h))) return 0;
    const double now = microseconds();
    cost[k] += now - last;
    last = now;
  }
  return 1;
}

static int take_step(Master* m, double t, double h, int first, double* cost) {
  if (m->exchange != rollback) return all(m, take_for_good, t, h, cost);
  return predict(m, h, first) && all(m, try_out, t, h, cost) && master_exchange(m, 1) && all(m, undo, t, h, cost) &&
         correct(m, h) && all(m, take_again, t, h, cost);
}

long master_run(Master* m, double h, long from, long to, double* cost) {
  long i = from;
  for (int going = 1; going && i < to; i += going) {
    const double t = (double)i * h, begin = microseconds();
    double* spent = cost + i * (m->components + 1);
    going = (i == from || master_exchange(m, m->exchange != held)) &&
            take_step(m, t, (double)(i + 1) * h - t, i == 0, spent + 1);
    spent[0] = microseconds() - begin;
  }
  for (Component* c = m->component; c < m->component + m->components; ++c) c->fmi2FreeFMUstate(c->instance, &c->state);
  return i;
}
