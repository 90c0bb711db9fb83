/* Exchange and steps; master.h explains them. */
#include "master.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { max_components = 32, max_transfers = 256, max_variables = 256, max_signals = 1024, max_records = 1024 };

typedef struct Component {
  Functions call;
  fmi2Component instance;
  fmi2FMUstate state; /* the snapshot, kept from step to step */
} Component;

typedef struct Transfer {
  int component, reads, count, signals[max_variables];
  fmi2ValueReference variables[max_variables];
} Transfer;

typedef struct Record {
  int component;
  fmi2ValueReference variable;
  Kind kind;
} Record;

typedef double Signals[max_signals];

struct Master {
  Exchange exchange;
  int reject, refused, component_count, transfer_count, record_count;
  Component components[max_components];
  Transfer transfers[max_transfers];
  Record records[max_records];
  Signals value, rate;             /* as they were last read */
  Signals begin_value, begin_rate; /* at the begin of a step with rollback */
};

Master* master_new(Exchange exchange, int reject) {
  Master* m = calloc(1, sizeof *m);
  if (m) m->exchange = exchange, m->reject = reject;
  return m;
}

void master_free(Master* m) {
  for (int i = 0; i < m->component_count; ++i)
    m->components[i].call.forget(m->components[i].instance, &m->components[i].state);
  free(m);
}

int master_component(Master* m, fmi2Component instance, const Functions* functions) {
  if (m->component_count == max_components) return 0;
  m->components[m->component_count++] = (Component){*functions, instance, NULL};
  return 1;
}

int master_transfer(Master* m, int component, int reads, int count, const fmi2ValueReference variables[],
                    const int signals[]) {
  if (m->transfer_count == max_transfers || count > max_variables) return 0;
  Transfer* t = &m->transfers[m->transfer_count++];
  t->component = component, t->reads = reads, t->count = count;
  for (int k = 0; k < count; ++k) {
    if (signals[k] >= max_signals) return 0;
    t->variables[k] = variables[k], t->signals[k] = signals[k];
  }
  return 1;
}

int master_record(Master* m, int component, fmi2ValueReference variable, Kind kind) {
  if (m->record_count == max_records) return 0;
  m->records[m->record_count++] = (Record){component, variable, kind};
  return 1;
}

int master_refused(const Master* m) { return m->refused; }

static int allowed(Master* m, int component, fmi2Status status) {
  if (status > fmi2Warning) m->refused = component;
  return status <= fmi2Warning;
}

static fmi2Status call(const Component* c, const Transfer* t, fmi2Integer order, double* numbers) {
  fmi2Integer orders[max_variables];
  const size_t n = (size_t)t->count;
  for (int k = 0; k < t->count; ++k) orders[k] = order;
  if (t->reads)
    return order ? c->call.rates(c->instance, t->variables, n, orders, numbers)
                 : c->call.get(c->instance, t->variables, n, numbers);
  return order ? c->call.set_rates(c->instance, t->variables, n, orders, numbers)
               : c->call.set(c->instance, t->variables, n, numbers);
}

/* All transfers in turn, of values (order 0) or derivatives of this order; reads: outputs too, else inputs are set to
 * the signals as they are. */
static int transfer(Master* m, fmi2Integer order, int reads, double* signals) {
  double numbers[max_variables];
  for (int i = 0; i < m->transfer_count; ++i) {
    const Transfer* t = &m->transfers[i];
    if (t->reads && !reads) continue;
    for (int k = 0; k < t->count; ++k) numbers[k] = signals[t->signals[k]];
    if (!allowed(m, t->component, call(&m->components[t->component], t, order, numbers))) return 0;
    for (int k = 0; k < t->count; ++k) signals[t->signals[k]] = numbers[k];
  }
  return 1;
}

int master_exchange(Master* m, int with_rates) {
  return transfer(m, 0, 1, m->value) && (!with_rates || transfer(m, 1, 1, m->rate));
}

/* Before the first trial of a step with rollback: second derivatives, guessed from the last step's rates. */
static int predict(Master* m, double h, int first) {
  Signals second;
  for (int k = 0; k < max_signals; ++k) second[k] = (m->rate[k] - m->begin_rate[k]) / h;
  memcpy(m->begin_value, m->value, sizeof m->value);
  memcpy(m->begin_rate, m->rate, sizeof m->rate);
  return first || transfer(m, 2, 0, second);
}

/* After it, with all components set back: the values of the step's begin, and the cubics. */
static int correct(Master* m, double h) {
  Signals second, third;
  for (int k = 0; k < max_signals; ++k) {
    const double mean = (m->value[k] - m->begin_value[k]) / h, begin = m->begin_rate[k], end = m->rate[k];
    second[k] = 2 * (3 * mean - 2 * begin - end) / h;
    third[k] = 6 * (begin + end - 2 * mean) / (h * h);
  }
  return transfer(m, 0, 0, m->begin_value) && transfer(m, 1, 0, m->begin_rate) && transfer(m, 2, 0, second) &&
         transfer(m, 3, 0, third);
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
  if (act == undo) return c->call.restore(c->instance, c->state);
  const fmi2Status kept = act == try_out ? c->call.keep(c->instance, &c->state) : fmi2OK;
  return kept == fmi2OK ? c->call.step(c->instance, t, h, act == take_for_good) : kept;
}

static int all(Master* m, Act act, double t, double h, double* cost) {
  double last = microseconds();
  for (int k = 0; k < m->component_count; ++k) {
    if (!allowed(m, k, act_on(&m->components[k], act, t, h))) return 0;
    const double now = microseconds();
    cost[k] += now - last;
    last = now;
  }
  return 1;
}

static int take_step(Master* m, double t, double h, int first, double* cost) {
  if (m->exchange == rollback)
    return predict(m, h, first) && all(m, try_out, t, h, cost) && master_exchange(m, 1) && all(m, undo, t, h, cost) &&
           correct(m, h) && all(m, take_again, t, h, cost);
  if (m->reject) return all(m, try_out, t, h, cost) && all(m, undo, t, h, cost) && all(m, take_again, t, h, cost);
  return all(m, take_for_good, t, h, cost);
}

/* The records before a step, or those at its end. */
static int record(Master* m, double* row, int after) {
  const fmi2Integer one = 1;
  for (int i = 0; i < m->record_count; ++i) {
    const Record* r = &m->records[i];
    const Component* c = &m->components[r->component];
    if ((r->kind == at_end) != after) continue;
    const fmi2Status status = r->kind == rate ? c->call.rates(c->instance, &r->variable, 1, &one, row + 1 + i)
                                              : c->call.get(c->instance, &r->variable, 1, row + 1 + i);
    if (!allowed(m, r->component, status)) return 0;
  }
  return 1;
}

long master_run(Master* m, double h, long from, long to, long every, double* rows, double* cost) {
  for (long i = from; i <= to; ++i) {
    const double t = (double)i * h;
    double begin = microseconds();
    double *row = rows + i / every * (m->record_count + 1), *spent = cost + i * (m->component_count + 1);
    const int kept = i % every == 0;
    if (i > from || to == 0) {
      if (!master_exchange(m, m->exchange != held)) return i;
      const double before = microseconds();
      if (kept) row[0] = t;
      if (kept && !record(m, row, 0)) return i;
      begin += microseconds() - before;
    }
    if (i == to) break;
    if (!take_step(m, t, (double)(i + 1) * h - t, i == 0, spent + 1)) return i;
    spent[0] = microseconds() - begin;
    if (kept && !record(m, row, 1)) return i;
  }
  return to;
}
