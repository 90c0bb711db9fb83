// The nine inputs are polynomials of time over one communication step: the external column {F} of (15) without the
// weight, the brake, and the rates of the wheel carrier of a guided wheel.
//
// F_X, F_Y, F_Z [N] at O along the fixed axes; M_1, M_2, M_3 [N m] along e1, e2, e3; M_brake [N m], the capacity of the
// dry brake; psi_dot_guide, theta_dot_guide [rad/s], whose slopes are the load's `guide`. What the caller asks for is
// in force from the next step on, in model exchange at once.
#pragma once

#include "wheel_equations.h"

namespace wheel {

inline constexpr int inputs_count = 9, brake_input = 6, guide_input = 7, max_order = 3;
inline constexpr int most_extremes = inputs_count * (max_order - 1) + (inputs_count - guide_input);

inline constexpr double factorial[] = {1, 1, 2, 6};
// c[i][k] = derivative of order k at the origin, divided by k!: input(t) = c[i][0] + c[i][1] (t - origin) + ...
using Polynomials = double[inputs_count][max_order + 1];

// (polynomial) => whether it depends on time
bool has_derivatives(const double (&c)[max_order + 1]);

// (inputs) => whether one depends on time
bool varies(const Polynomials& inputs);

// (inputs) => whether a rate of the carrier or one of its derivatives is not zero
bool is_guiding(const Polynomials& inputs);

// (polynomial, tau: s) => least and largest value from its origin to tau, infinite where a value overflows
struct Span {
  double least, largest;
};
Span span_of(const double (&c)[max_order + 1], double tau);

// The inputs in force.
struct Inputs {
  double origin = 0;  // s, clock of the run
  Polynomials c = {};
  // What follows from the polynomials.
  bool loaded = false;  // some input is not zero
  bool braked = false;  // the brake is in use: its capacity or one of its derivatives is not zero
  bool varies = false;  // some input depends on time
  bool guides = false;  // the carrier's rates or one of their derivatives are not zero

  void take_over(double t, const Polynomials& asked);
  // Whether `asked`, seen from t on, differs from the polynomials in force by more than the rounding of their values
  // and of t, s. So a polynomial that a caller cuts into many steps goes on as one.
  bool change_at(double t, double rounding, const Polynomials& asked) const;
  void set_load_at(double t, WheelLoad& load) const;
  // The rates of the load at t. A brake's capacity is never negative: where its polynomial is zero, the rate is not
  // negative either, and where it is below zero, the rate is zero.
  WheelLoad load_rate_at(double t) const;
  // (input, t) => its value; a brake's is not below zero
  double value_of(int input, double t) const;
  // (t_lo, t_hi) => instants strictly between them, ascending, at which an input, or the acceleration of the carrier,
  // has an extreme; returns their number
  int extremes(double t_lo, double t_hi, double* instants) const;
  // (t, until) => the first instant in (t, until] at which the brake's polynomial passes zero, where the capacity has a
  // corner, s; infinite where there is none
  double corner(double t, double until) const;
};

// (load, input) => the entry that the input, or its slope, sets
double* load_entry(WheelLoad& load, int input);

}  // namespace wheel
