/* Reading of a plan; plan.h has its lines. */
#include "plan.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static Component* component(Plan* plan, const char* name) {
  for (int i = 0; i < plan->component_count; ++i)
    if (name && !strcmp(plan->components[i].name, name)) return &plan->components[i];
  give_up("the plan names a component that it does not have", name ? name : "(none)");
}

static const char* word(void) { return strtok(NULL, " \n"); }

static const char* needed(const char* what) {
  const char* found = word();
  if (!found) give_up("a line of the plan ends early", what);
  return found;
}

static void read_component(Plan* plan) {
  if (plan->component_count == max_components) give_up("too many components", "plan");
  const char *name = needed("component"), *library = needed("component"), *guid = needed("component");
  component_load(&plan->components[plan->component_count++], name, library, guid);
}

static void read_real(Plan* plan) {
  const Component* c = component(plan, needed("real"));
  const fmi2ValueReference reference = (fmi2ValueReference)strtoul(needed("real"), NULL, 10);
  const double value = strtod(needed("real"), NULL);
  if (c->set(c->instance, &reference, 1, &value) != fmi2OK) give_up("does not take a start value", c->name);
}

static void read_transfer(Plan* plan) {
  if (plan->transfer_count == max_transfers) give_up("too many transfers", "plan");
  Transfer* t = &plan->transfers[plan->transfer_count++];
  t->source = component(plan, needed("transfer"));
  for (const char* w = word(); w && t->count < max_signals; w = word())
    t->outputs[t->count++] = (fmi2ValueReference)strtoul(w, NULL, 10);
}

static void read_sink(Plan* plan) {
  if (!plan->transfer_count) give_up("a sink stands before all transfers", "plan");
  Transfer* t = &plan->transfers[plan->transfer_count - 1];
  if (t->sink_count == max_sinks) give_up("too many sinks", "plan");
  Sink* s = &t->sinks[t->sink_count++];
  s->component = component(plan, needed("sink"));
  for (const char* w = word(); w && s->count < max_signals; w = word()) {
    char* equals;
    s->inputs[s->count] = (fmi2ValueReference)strtoul(w, &equals, 10);
    s->at[s->count] = *equals == '=' ? atoi(equals + 1) : t->count;
    if (s->at[s->count] < 0 || s->at[s->count] >= t->count) give_up("a sink's index is not among the outputs", w);
    ++s->count;
  }
}

static void read_record(Plan* plan) {
  if (plan->record_count == max_records) give_up("too many records", "plan");
  Record* r = &plan->records[plan->record_count++];
  r->component = component(plan, needed("record"));
  r->variable = (fmi2ValueReference)strtoul(needed("record"), NULL, 10);
}

static void read_run(Plan* plan) {
  plan->step = strtod(needed("run"), NULL);
  plan->stop = strtod(needed("run"), NULL);
  static const char* const names[] = {"held", "derivatives", "rollback"};
  const char* name = needed("run");
  int which = 0;
  while (which < 3 && strcmp(name, names[which])) ++which;
  if (which == 3) give_up("is not an exchange; held, derivatives and rollback are", name);
  plan->exchange = (Exchange)which;
  plan->every = strtol(needed("run"), NULL, 10);
}

void plan_read(const char* file, Plan* plan) {
  static const struct {
    const char* word;
    void (*read)(Plan*);
  } lines[] = {{"component", read_component}, {"real", read_real},     {"transfer", read_transfer},
               {"sink", read_sink},           {"record", read_record}, {"run", read_run}};
  static char line[1 << 16];
  FILE* input = fopen(file, "r");
  if (!input) give_up("cannot be opened", file);
  while (fgets(line, sizeof line, input)) {
    const char* first = strtok(line, " \n");
    for (size_t i = 0; first && i < sizeof lines / sizeof *lines; ++i)
      if (!strcmp(first, lines[i].word)) lines[i].read(plan);
  }
  fclose(input);
  if (!(plan->step > 0) || !(plan->stop > 0) || plan->every < 1)
    give_up("the plan needs a line `run` with step, stop and every above 0", file);
}
