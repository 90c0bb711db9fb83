/* What the C master is to do, read from a text file that vehicles/plan.py writes:
 *
 *   component NAME LIBRARY GUID             a component, instantiated from the library
 *   real NAME REFERENCE VALUE               a start value of it
 *   transfer NAME REFERENCE...              outputs of it that are read together ...
 *   sink NAME REFERENCE=INDEX...            ... and the inputs they go to, by their index among those outputs
 *   record NAME REFERENCE                   a variable of the table that is printed
 *   run STEP STOP EXCHANGE EVERY            s, s, held, derivatives or rollback; the table has every EVERYth step
 *
 * Transfers stand in an order in which each output is read after the inputs it depends on. */
#ifndef PLAN_H
#define PLAN_H

#include "component.h"

enum { max_components = 32, max_transfers = 64, max_sinks = 32, max_signals = 256, max_records = 1024 };

typedef struct Sink {
  Component* component;
  int count, at[max_signals];
  fmi2ValueReference inputs[max_signals];
} Sink;

typedef struct Transfer {
  Component* source;
  int count, sink_count;
  fmi2ValueReference outputs[max_signals];
  Sink sinks[max_sinks];
  double value[max_signals], rate[max_signals];             /* as they were last read */
  double begin_value[max_signals], begin_rate[max_signals]; /* at the begin of a step with rollback */
} Transfer;

typedef struct Record {
  Component* component;
  fmi2ValueReference variable;
} Record;

typedef enum Exchange { held, derivatives, rollback } Exchange;

typedef struct Plan {
  int component_count, transfer_count, record_count;
  Exchange exchange;
  double step, stop;
  long every;
  Component components[max_components];
  Transfer transfers[max_transfers];
  Record records[max_records];
} Plan;

/* Reads the plan, and loads and instantiates its components. Says what is wrong and ends the program if it must. */
void plan_read(const char* file, Plan* plan);

#endif
