// DOP853 (Dormand and Prince, order 8 with dense output of order 7) with the wheel's right-hand side inlined: the
// fastest Runge-Kutta solution of the wheel that the speed report knows. Coefficients:
// fmu-src/solver/dormand_prince.hpp. Step control, error norm and dense output are those of SciPy's DOP853, with one
// tolerance for relative and absolute error.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

extern "C" {
#include "reduced.c"
}
#include "dormand_prince.hpp"

namespace pair = solver::dormand_prince;
using State = std::array<double, WHEEL_REDUCED_STATES>;
constexpr int size = WHEEL_REDUCED_STATES;

class Dop853 {
 public:
  Dop853(const WheelScene& of, const State& y, double tolerance) : scene(of), tolerance_(tolerance) { restart(0, y); }

  // From y at t, with the step size reached so far.
  void restart(double t, const State& y) {
    t_ = t_old_ = t;
    y_ = y;
    interpolates_ = false;
    evaluate(y_, f_[0]);
    if (h_ == 0) h_ = first_step();
  }

  // One accepted step. False: the step became too small.
  bool step() {
    if (t_ > t_old_) f_[0] = f_[12];
    for (bool rejected = false;; rejected = true) {
      if (h_ < 1e-14 * std::fmax(1, t_)) return false;
      try_step();
      const double error = step_error();
      const double factor = 0.9 * std::pow(error, -1.0 / 8);
      h_done_ = h_;
      h_ *= error < 1 ? (rejected ? std::fmin(1, factor) : std::fmin(10, factor)) : std::fmax(0.2, factor);
      if (error < 1) break;
    }
    ++steps;
    y_old_ = y_, y_ = y_new_;
    t_old_ = t_, t_ += h_done_;
    interpolates_ = false;
    return true;
  }

  // y(t) inside the last step; the three further stages are evaluated once per step, and only if asked for.
  State at(double t) {
    if (!interpolates_) prepare_interpolant();
    const double x = (t - t_old_) / h_done_;
    State y{};
    for (int i = 6; i >= 0; --i)
      for (int c = 0; c < size; ++c) y[c] = (y[c] + F_[i][c]) * (i % 2 ? 1 - x : x);
    for (int c = 0; c < size; ++c) y[c] += y_old_[c];
    return y;
  }

  double t() const { return t_; }
  double t_old() const { return t_old_; }
  const State& y() const { return y_; }
  WheelScene scene;
  long steps = 0, evaluations = 0;

 private:
  void evaluate(const State& y, State& y_dot) {
    derivative(&scene, y.data(), y_dot.data());
    ++evaluations;
  }

  // The sum of a row's terms, unrolled at compile time.
  template <const auto& row>
  State combine() const {
    State sum{};
    [&]<std::size_t... j>(std::index_sequence<j...>) {
      (([&] {
         for (int c = 0; c < size; ++c) sum[c] += row[j].weight * f_[row[j].stage][c];
       }()),
       ...);
    }(std::make_index_sequence<std::size(row)>());
    return sum;
  }

  template <int stage, const auto& row>
  void evaluate_stage(const State& from, double h) {
    State y = combine<row>();
    for (int c = 0; c < size; ++c) y[c] = from[c] + h * y[c];
    evaluate(y, f_[stage]);
  }

  void try_step() {
    evaluate_stage<1, pair::a_1>(y_, h_), evaluate_stage<2, pair::a_2>(y_, h_);
    evaluate_stage<3, pair::a_3>(y_, h_), evaluate_stage<4, pair::a_4>(y_, h_);
    evaluate_stage<5, pair::a_5>(y_, h_), evaluate_stage<6, pair::a_6>(y_, h_);
    evaluate_stage<7, pair::a_7>(y_, h_), evaluate_stage<8, pair::a_8>(y_, h_);
    evaluate_stage<9, pair::a_9>(y_, h_), evaluate_stage<10, pair::a_10>(y_, h_);
    evaluate_stage<11, pair::a_11>(y_, h_);
    const State increment = combine<pair::b>();
    for (int c = 0; c < size; ++c) y_new_[c] = y_[c] + h_ * increment[c];
    evaluate(y_new_, f_[12]);
  }

  double step_error() const {
    const State e_5 = combine<pair::e_5>(), e_3 = combine<pair::e_3>();
    double sum_5 = 0, sum_3 = 0;
    for (int c = 0; c < size; ++c) {
      const double scale = tolerance_ * (1 + std::fmax(std::fabs(y_[c]), std::fabs(y_new_[c])));
      sum_5 += e_5[c] / scale * (e_5[c] / scale);
      sum_3 += e_3[c] / scale * (e_3[c] / scale);
    }
    const double both = sum_5 + 0.01 * sum_3;
    if (both == 0) return 1e-9;
    const double error = h_ * sum_5 / std::sqrt(both * size);
    return std::isfinite(error) ? std::fmax(error, 1e-9) : 1e9;
  }

  // A guess from the size of y' alone; the first steps correct it.
  double first_step() const {
    double rate = 0;
    for (int c = 0; c < size; ++c) rate = std::fmax(rate, std::fabs(f_[0][c]) / (1 + std::fabs(y_[c])));
    return 0.5 * std::pow(tolerance_, 1.0 / 8) / std::fmax(rate, 1e-3);
  }

  void prepare_interpolant() {
    evaluate_stage<13, pair::a_13>(y_old_, h_done_), evaluate_stage<14, pair::a_14>(y_old_, h_done_);
    evaluate_stage<15, pair::a_15>(y_old_, h_done_);
    const State high[] = {combine<pair::d_3>(), combine<pair::d_4>(), combine<pair::d_5>(), combine<pair::d_6>()};
    for (int c = 0; c < size; ++c) {
      const double delta = y_[c] - y_old_[c];
      F_[0][c] = delta;
      F_[1][c] = h_done_ * f_[0][c] - delta;
      F_[2][c] = 2 * delta - h_done_ * (f_[12][c] + f_[0][c]);
      for (int i = 0; i < 4; ++i) F_[3 + i][c] = h_done_ * high[i][c];
    }
    interpolates_ = true;
  }

  double tolerance_, t_, t_old_, h_ = 0, h_done_ = 0;
  bool interpolates_ = false;
  State y_, y_old_{}, y_new_;
  std::array<State, 16> f_{};
  std::array<State, 7> F_;
};
