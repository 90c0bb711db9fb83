// The seven inputs as polynomials of time over one communication step: the external column {F} of (15) besides the
// weight, and the brake.
//
// F_X, F_Y, F_Z [N] at O along the fixed axes; M_1, M_2, M_3 [N m] along the carrier axes e1, e2, e3; M_brake [N m],
// the capacity of the dry brake. What the master sets is pending until the next step starts; then it is in force.
#pragma once

#include "wheel_equations.h"

namespace wheel {

struct Inputs {
  static constexpr int count = 7, brake = 6, max_order = 3;
  static constexpr int most_extremes = count * (max_order - 1);

  // c[i][k] = derivative of order k at the origin, divided by k!: input(t) = c[i][0] + c[i][1] (t - origin) + ...
  using Polynomials = double[count][max_order + 1];

  double origin = 0;  // s, own clock
  Polynomials in_force = {}, pending = {};
  // Of the polynomials in force, by classify():
  bool loaded = false;  // some input is not zero
  bool braked = false;  // the brake is in use: its capacity or one of its derivatives is not zero
  bool varies = false;  // some input depends on time

  // Pending values. A derivative holds for one step: at its end, t, every input stays where its polynomial arrived.
  double value(int input) const { return pending[input][0]; }
  bool set_value(int input, double value);  // false: it had this value
  void set_derivative(int input, int order, double derivative);
  void hold_from(double t);

  // Whether the pending polynomials differ from those in force, seen from t on, by more than the rounding of their
  // values and of t, s: a polynomial that a master cuts into many steps goes on as one.
  bool change_at(double t, double rounding) const;
  void take_over(double t);
  void classify();

  // The load of the polynomials in force at t.
  void load_at(double t, WheelLoad* load) const;
  // The same of what is pending, at the instant it was set, and its rate.
  void pending_load(WheelLoad* load) const;
  WheelLoad pending_rate() const;
  bool pending_brake() const;

  // Instants strictly inside (t_lo, t_hi), ascending, at which an input in force has an extreme; returns their number.
  int extremes(double t_lo, double t_hi, double* instants) const;
};

// The entry of a load that one input sets.
double* load_entry(WheelLoad& load, int input);

}  // namespace wheel
