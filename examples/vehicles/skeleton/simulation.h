/* One instance of an example: stored values, states, and the step that advances them. No FMI here. */
#ifndef SIMULATION_H
#define SIMULATION_H

#include "model.h"

enum { input_orders = 3, sentence_size = 160 };

typedef struct Simulation {
  Now now;
  double x[max_states];
  double slope[input_orders][input_count]; /* derivatives of the inputs, for one step */
  int given[input_count];                  /* whether the master gave the first derivative for this step */
} Simulation;

void simulation_reset(Simulation* s);
/* States from the parameters; NULL, or the sentence that says which parameter is wrong. */
const char* simulation_start(Simulation* s, char sentence[sentence_size]);
/* From t to t + h: the inputs follow their polynomials, which are used up. With the parameter `follow`, an input whose
 * rate is an input too follows that rate where the master gives no derivative: a position that is held would lag. */
void simulation_step(Simulation* s, double h);
/* Outputs and locals now, y[variable_count] by value reference. */
void simulation_outputs(const Simulation* s, double* y);
/* Their first derivatives along the motion, with the inputs on their slopes. */
void simulation_output_rates(const Simulation* s, double* y_dot);

#endif
