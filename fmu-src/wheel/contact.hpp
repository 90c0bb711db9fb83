// Whether the wheel rolls or slides, and what is in force where that is decided. Pure functions of setup, load and
// state.
#pragma once

#include "run.hpp"

namespace wheel {

// Puts in force, at the state y, what is asked for: road, inputs from t on, and the contact and the law of friction
// that go with them. Writes the slip in y.
void put_in_force(const Setup& setup, const Demand& demand, double t, double* y, InForce& in_force);

// Decides contact and law from t and y on. A slip that is more than nothing goes on; else the wheel rolls where it can,
// and begins to slide where it cannot. Writes the slip in y.
void decide_contact(const Setup& setup, double t, double* y, InForce& in_force);

// The wheel, without slip at y, starts to slide: Coulomb's law, in the direction in which it lets a slip grow and stay.
void begin_slide(const Setup& setup, double t, double* y, InForce& in_force);

// The direction in which a slip begins, at a state of the reduced form. Without one the event that ends the run follows
// at once, or the ground begins to pull: where it pulls, the slip begins along the forces.
double first_direction(const WheelScene& scene, const double* reduced);

// m/s. A slide ends at the least slip, below which its direction turns ever faster, and begins with twice as much:
// small parts of the tolerance, and large enough for the digits of an instant.
double least_slip(const Setup& setup, double t);

// Whether the road limits the force of rolling: mu_max = 0 is no limit, and of a wheel that can slide no friction.
inline bool is_limited(const Setup& setup, const Road& road) { return setup.sliding || road.mu_max > 0; }

// N^2 - (lambda_t / mu_max)^2 over the weight squared, of a wheel that rolls; below zero too where the ground pulls.
double grip_left(const Setup& setup, const InForce& now, double t, const double* y);

}  // namespace wheel
