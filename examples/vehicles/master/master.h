/* The loop of a parallel (Jacobi) co-simulation master with fixed steps. vehicles/master.py loads and initializes the
 * FMUs, fills a Master, whose arrays it owns, and calls these functions; nothing here allocates or prints. */
#pragma once

#include "fmi2FunctionTypes.h"

typedef struct Component {
  fmi2GetRealTYPE* fmi2GetReal;
  fmi2SetRealTYPE* fmi2SetReal;
  fmi2GetRealOutputDerivativesTYPE* fmi2GetRealOutputDerivatives;
  fmi2SetRealInputDerivativesTYPE* fmi2SetRealInputDerivatives;
  fmi2DoStepTYPE* fmi2DoStep;
  fmi2GetFMUstateTYPE* fmi2GetFMUstate;
  fmi2SetFMUstateTYPE* fmi2SetFMUstate;
  fmi2FreeFMUstateTYPE* fmi2FreeFMUstate;
  fmi2Component instance;
  fmi2FMUstate state; /* the snapshot, kept from step to step of one call */
} Component;

/* Variables of a component that are read (outputs) or set (inputs) together, and the signals that they exchange,
 * counted from 0. */
typedef struct Transfer {
  int component, reads, count;
  const fmi2ValueReference* variables;
  const int* signals;
} Transfer;

/* Of inputs over a step. held: constant. derivatives: straight lines. rollback: parabolas, the step is undone, and
 * taken again on the cubics through values and first derivatives at both ends. */
typedef enum Exchange { held, derivatives, rollback } Exchange;

typedef struct Master {
  Exchange exchange;
  int refused; /* the component that refused last */
  int components, transfers, signals;
  Component* component;
  const Transfer* transfer; /* in the order of exchange: each output is read after the inputs that it depends on */
  double *value, *rate;     /* of the signals, as they were last read */
  double *begin_value, *begin_rate, *second, *third; /* at the begin of a step with rollback */
} Master;

/* Hands on all outputs, with_rates: and their first derivatives; 0 where a component refuses. */
int master_exchange(Master* m, int with_rates);
/* Steps `from` to `to` of the length h with the exchanges between them; the first was made before. Row i of `cost` has
 * the microseconds of step i, all of it and in each component. Returns `to`, or the step that a component refused. */
long master_run(Master* m, double h, long from, long to, double* cost);
