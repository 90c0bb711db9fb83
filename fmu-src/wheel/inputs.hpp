// The six inputs, F_X F_Y F_Z (fixed axes, at O) and M_1 M_2 M_3 (carrier axes), as polynomials over a step: {F} of
// (15).
#pragma once

#include <initializer_list>

#include "wheel_equations.h"

namespace wheel {

class Inputs {
 public:
  static constexpr int count = 6, max_order = 3;

  // value(t) = c_0 + c_1 (t - origin) + ... with the origin at the current communication point.
  void set_value(int input, double value);
  bool holds(int input, double value) const { return pending_[input][0] == value; }
  void set_derivative(int input, int order, double derivative);
  // Derivatives hold for one step; at its end, t, an input stays where its polynomial arrived until it is set again.
  void hold_from(double t);

  bool differ_from_current(double t) const;
  // Makes what was set the polynomials in force from t on.
  void take_over(double t);

  // False: all inputs are zero and no term of them is evaluated.
  bool loaded() const { return loaded_; }
  bool varies() const { return varies_; }
  void load_at(double t, WheelScene* scene) const;
  WheelLoad rate_at(double t) const;
  // What was set, at the instant it was set.
  void pending_load(WheelScene* scene) const;
  WheelLoad pending_rate() const;

  template <class Archive>
  void visit(Archive& archive) {
    archive(origin_);
    for (auto* block : {&current_, &pending_})
      for (auto& polynomial : *block)
        for (double& coefficient : polynomial) archive(coefficient);
    archive(loaded_);
    archive(varies_);
  }

 private:
  using Polynomials = double[count][max_order + 1];  // Taylor coefficients: derivative / order!
  static double evaluate(const double* coefficients, double tau);

  double origin_ = 0;
  Polynomials current_ = {}, pending_ = {};
  bool loaded_ = false, varies_ = false;
};

}  // namespace wheel
