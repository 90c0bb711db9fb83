/* A rigid body on hubs, as axle and chassis are: its rates, from what the example says of its hubs. The body's states
 * come first, then its heading; the derived quantities begin with gravity. */
#ifndef VEHICLE_H
#define VEHICLE_H

#include "hub.h"
#include "model.h"

enum { x_psi = body_states, vehicle_states };
enum { at_g = 0, vehicle_derived = 3 };

/* By the example: the hubs with their forces and moments; until t_couple they carry the weight alone. */
void hubs(const Now* now, const Body* body, Hub hub[wheel_count]);
/* By the example: what else acts on the body, and the rates of further states. */
void further(const Now* now, const Hub hub[wheel_count], Body* body, double* x_dot);

#endif
