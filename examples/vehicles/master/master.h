/* The loop of a parallel (Jacobi) co-simulation master with fixed steps. vehicles/master.py loads and initializes the
 * FMUs, orders the transfers and calls these functions; nothing here allocates after the first step or prints. */
#ifndef MASTER_H
#define MASTER_H

#include "fmi2FunctionTypes.h"

#if defined _WIN32
#define MASTER_API __declspec(dllexport)
#else
#define MASTER_API __attribute__((visibility("default")))
#endif

typedef struct Functions {
  fmi2GetRealTYPE* get;
  fmi2SetRealTYPE* set;
  fmi2GetRealOutputDerivativesTYPE* rates;
  fmi2SetRealInputDerivativesTYPE* set_rates;
  fmi2DoStepTYPE* step;
  fmi2GetFMUstateTYPE* keep;
  fmi2SetFMUstateTYPE* restore;
  fmi2FreeFMUstateTYPE* forget;
} Functions;

/* held: inputs keep their values over a step. derivatives: straight lines. rollback: parabolas, the step is undone, and
 * taken again on the cubics through values and first derivatives at both ends. */
typedef enum Exchange { held, derivatives, rollback } Exchange;
/* A recorded number: an output at a communication point, its derivative there, or the output at the end of the step
 * that begins there, before inputs are exchanged. */
typedef enum Kind { value, rate, at_end } Kind;
typedef struct Master Master;

/* reject: every step is taken, undone from a snapshot and taken again, as an error-controlled master may do. */
MASTER_API Master* master_new(Exchange exchange, int reject);
MASTER_API void master_free(Master* m);
/* These return 0 where there is no room for more. */
MASTER_API int master_component(Master* m, fmi2Component instance, const Functions* functions);
/* Variables of a component that are read (outputs) or set (inputs) together; `signals`: the numbers that they exchange,
 * counted from 0. Transfers stand in the order of exchange: each output is read after the inputs that it depends on. */
MASTER_API int master_transfer(Master* m, int component, int reads, int count, const fmi2ValueReference variables[],
                               const int signals[]);
MASTER_API int master_record(Master* m, int component, fmi2ValueReference variable, Kind kind);
/* Hands on all outputs, with_rates: and their first derivatives; 0 where a component refuses. */
MASTER_API int master_exchange(Master* m, int with_rates);
/* Steps `from` to `to` of the length h, and at `to` the exchange and the record; those at `from` were made by the call
 * before, the first of all with `to` = 0. Row k of `rows` is time and records at
 * step k * every; row i of `cost` has the microseconds of step i, all of it and in each component. Returns `to`, or the
 * step that a component refused. */
MASTER_API long master_run(Master* m, double h, long from, long to, long every, double* rows, double* cost);
/* The component that refused last. */
MASTER_API int master_refused(const Master* m);

#endif
