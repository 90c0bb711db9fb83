/* Values and derivatives from outputs to inputs, along the transfers of a plan. */
#ifndef EXCHANGE_H
#define EXCHANGE_H

#include "plan.h"

/* Every output is read and handed on; with_rates: the outputs' first derivatives too. */
void exchange(Plan* plan, int with_rates);
/* Before the first trial of a step of h seconds with rollback: second derivatives, guessed from the last step's rates
 * (not at the first step, when there are none). Keeps what the transfers hold. */
void predict(Plan* plan, double h, int first);
/* After it, with all components set back: the values of the step's begin, and the cubics through values and rates at
 * both ends of the step. */
void correct(Plan* plan, double h);

#endif
