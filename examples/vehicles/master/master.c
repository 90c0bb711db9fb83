/* Exchange and steps; master.h has them in words. */
#include "master.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { max_components = 32, max_transfers = 64, max_sinks = 32, max_signals = 256, max_records = 1024 };

typedef struct Component {
  Functions call;
  fmi2Component instance;
  fmi2FMUstate state; /* the snapshot, kept from step to step */
} Component;

typedef struct Sink {
  int component, count, at[max_signals];
  fmi2ValueReference inputs[max_signals];
} Sink;

typedef struct Transfer {
  int component, count, sink_count;
  fmi2ValueReference outputs[max_signals];
  Sink sinks[max_sinks];
  double value[max_signals], rate[max_signals];             /* as they were last read */
  double begin_value[max_signals], begin_rate[max_signals]; /* at the begin of a step with rollback */
} Transfer;

typedef struct Record {
  int component;
  fmi2ValueReference variable;
  Kind kind;
} Record;

struct Master {
  Exchange exchange;
  int reject, refused, component_count, transfer_count, record_count;
  Component components[max_components];
  Transfer transfers[max_transfers];
  Record records[max_records];
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

int master_transfer(Master* m, int component, int count, const fmi2ValueReference outputs[]) {
  if (m->transfer_count == max_transfers || count > max_signals) return 0;
  Transfer* t = &m->transfers[m->transfer_count++];
  t->component = component, t->count = count;
  memcpy(t->outputs, outputs, (size_t)count * sizeof *outputs);
  return 1;
}

int master_sink(Master* m, int component, int count, const fmi2ValueReference inputs[], const int at[]) {
  Transfer* t = &m->transfers[m->transfer_count - 1];
  if (t->sink_count == max_sinks || count > max_signals) return 0;
  Sink* s = &t->sinks[t->sink_count++];
  s->component = component, s->count = count;
  memcpy(s->inputs, inputs, (size_t)count * sizeof *inputs);
  memcpy(s->at, at, (size_t)count * sizeof *at);
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

/* Sets values (order 0) or derivatives of this order, one per output of the transfer. */
static int hand(Master* m, const Transfer* t, fmi2Integer order, const double* values) {
  double chosen[max_signals];
  fmi2Integer orders[max_signals];
  for (int i = 0; i < t->sink_count; ++i) {
    const Sink* s = &t->sinks[i];
    const Component* to = &m->components[s->component];
    const size_t n = (size_t)s->count;
    for (int k = 0; k < s->count; ++k) chosen[k] = values[s->at[k]], orders[k] = order;
    const fmi2Status status = order ? to->call.set_rates(to->instance, s->inputs, n, orders, chosen)
                                    : to->call.set(to->instance, s->inputs, n, chosen);
    if (!allowed(m, s->component, status)) return 0;
  }
  return 1;
}

int master_exchange(Master* m, int with_rates) {
  fmi2Integer ones[max_signals];
  for (int i = 0; i < max_signals; ++i) ones[i] = 1;
  for (int order = 0; order <= (with_rates != 0); ++order)
    for (int i = 0; i < m->transfer_count; ++i) {
      Transfer* t = &m->transfers[i];
      const Component* from = &m->components[t->component];
      const size_t n = (size_t)t->count;
      const fmi2Status status = order ? from->call.rates(from->instance, t->outputs, n, ones, t->rate)
                                      : from->call.get(from->instance, t->outputs, n, t->value);
      if (!allowed(m, t->component, status) || !hand(m, t, order, order ? t->rate : t->value)) return 0;
    }
  return 1;
}

/* Before the first trial of a step with rollback: second derivatives, guessed from the last step's rates. Keeps what
 * the transfers hold. */
static int predict(Master* m, double h, int first) {
  double second[max_signals];
  for (int i = 0; i < m->transfer_count; ++i) {
    Transfer* t = &m->transfers[i];
    for (int k = 0; k < t->count; ++k) second[k] = (t->rate[k] - t->begin_rate[k]) / h;
    if (!first && !hand(m, t, 2, second)) return 0;
    memcpy(t->begin_value, t->value, sizeof t->value);
    memcpy(t->begin_rate, t->rate, sizeof t->rate);
  }
  return 1;
}

/* After it, with all components set back: the values of the step's begin, and the cubics. */
static int correct(Master* m, double h) {
  double second[max_signals], third[max_signals];
  for (int i = 0; i < m->transfer_count; ++i) {
    const Transfer* t = &m->transfers[i];
    const double *begin = t->begin_value, *rate = t->begin_rate;
    for (int k = 0; k < t->count; ++k) {
      const double mean = (t->value[k] - begin[k]) / h;
      second[k] = 2 * (3 * mean - 2 * rate[k] - t->rate[k]) / h;
      third[k] = 6 * (rate[k] + t->rate[k] - 2 * mean) / (h * h);
    }
    const double* of[] = {begin, rate, second, third};
    for (int order = 0; order < 4; ++order)
      if (!hand(m, t, order, of[order])) return 0;
  }
  return 1;
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
