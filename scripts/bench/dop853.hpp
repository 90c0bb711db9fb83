// DOP853 (Dormand and Prince, order 8 with dense output of order 7) with everything inlined: the fastest Runge-Kutta
// solution of y' = f(y) this report knows, as a yardstick. No paper equation, no frame.
//
// The coefficients are not here: dop853_tableau.h is written by the report's scripts from SciPy's tables. Step control,
// error norm and dense output are those of SciPy's DOP853, with one tolerance for relative and absolute error.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "dop853_tableau.h"

template <int N, class Rhs>
class Dop853 {
 public:
  using State = std::array<double, N>;

  Dop853(const Rhs& rhs, const State& y_0, double tolerance) : rhs_(rhs), tolerance_(tolerance) { restart(0, y_0); }

  // From y at t, with the step size reached so far.
  void restart(double t, const State& y) {
    t_ = t_old_ = t;
    y_ = y;
    interpolates_ = false;
    evaluate(y_, K_[0]);
    if (h_ == 0) h_ = first_step();
  }

  // One accepted step. False: the step became too small.
  bool step() {
    if (t_ > t_old_) K_[0] = K_[12];
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
    y_old_ = y_;
    y_ = y_new_;
    t_old_ = t_;
    t_ += h_done_;
    interpolates_ = false;
    return true;
  }

  // y(t) inside the last step; the three further stages are evaluated once per step, and only if asked for.
  State at(double t) {
    if (!interpolates_) prepare_interpolant();
    const double x = (t - t_old_) / h_done_;
    State y{};
    for (int i = 6; i >= 0; --i)
      for (int c = 0; c < N; ++c) y[c] = (y[c] + F_[i][c]) * (i % 2 ? 1 - x : x);
    for (int c = 0; c < N; ++c) y[c] += y_old_[c];
    return y;
  }

  double t() const { return t_; }
  double t_old() const { return t_old_; }
  const State& y() const { return y_; }
  Rhs& rhs() { return rhs_; }
  long steps = 0, evaluations = 0;

 private:
  void evaluate(const State& y, State& y_dot) {
    rhs_(y.data(), y_dot.data());
    ++evaluations;
  }

  // sum over j of Row[j] K_j, zeros left out at compile time.
  template <const auto& Row, std::size_t... j>
  State combine(std::index_sequence<j...>) const {
    State sum{};
    (([&] {
       if constexpr (Row[j] != 0)
         for (int c = 0; c < N; ++c) sum[c] += Row[j] * K_[j][c];
     }()),
     ...);
    return sum;
  }
  template <const auto& Row>
  State combine() const {
    return combine<Row>(std::make_index_sequence<Row.size()>());
  }

  template <int s, const auto& Row>
  void stage(const State& from, double h) {
    State y = combine<Row>();
    for (int c = 0; c < N; ++c) y[c] = from[c] + h * y[c];
    evaluate(y, K_[s]);
  }

  void try_step() {
    stage<1, tableau::A1>(y_, h_), stage<2, tableau::A2>(y_, h_), stage<3, tableau::A3>(y_, h_);
    stage<4, tableau::A4>(y_, h_), stage<5, tableau::A5>(y_, h_), stage<6, tableau::A6>(y_, h_);
    stage<7, tableau::A7>(y_, h_), stage<8, tableau::A8>(y_, h_), stage<9, tableau::A9>(y_, h_);
    stage<10, tableau::A10>(y_, h_), stage<11, tableau::A11>(y_, h_);
    const State increment = combine<tableau::B>();
    for (int c = 0; c < N; ++c) y_new_[c] = y_[c] + h_ * increment[c];
    evaluate(y_new_, K_[12]);
  }

  double step_error() const {
    const State e5 = combine<tableau::E5>(), e3 = combine<tableau::E3>();
    double sum5 = 0, sum3 = 0;
    for (int c = 0; c < N; ++c) {
      const double scale = tolerance_ * (1 + std::fmax(std::fabs(y_[c]), std::fabs(y_new_[c])));
      sum5 += e5[c] / scale * (e5[c] / scale);
      sum3 += e3[c] / scale * (e3[c] / scale);
    }
    const double both = sum5 + 0.01 * sum3;
    if (both == 0) return 1e-9;
    const double error = h_ * sum5 / std::sqrt(both * N);
    return std::isfinite(error) ? std::fmax(error, 1e-9) : 1e9;
  }

  // A guess from the size of y' alone; the first steps correct it.
  double first_step() const {
    double rate = 0;
    for (int c = 0; c < N; ++c) rate = std::fmax(rate, std::fabs(K_[0][c]) / (1 + std::fabs(y_[c])));
    return 0.5 * std::pow(tolerance_, 1.0 / 8) / std::fmax(rate, 1e-3);
  }

  void prepare_interpolant() {
    stage<13, tableau::A13>(y_old_, h_done_), stage<14, tableau::A14>(y_old_, h_done_);
    stage<15, tableau::A15>(y_old_, h_done_);
    const State d3 = combine<tableau::D0>(), d4 = combine<tableau::D1>();
    const State d5 = combine<tableau::D2>(), d6 = combine<tableau::D3>();
    for (int c = 0; c < N; ++c) {
      const double delta = y_[c] - y_old_[c];
      F_[0][c] = delta;
      F_[1][c] = h_done_ * K_[0][c] - delta;
      F_[2][c] = 2 * delta - h_done_ * (K_[12][c] + K_[0][c]);
      F_[3][c] = h_done_ * d3[c], F_[4][c] = h_done_ * d4[c];
      F_[5][c] = h_done_ * d5[c], F_[6][c] = h_done_ * d6[c];
    }
    interpolates_ = true;
  }

  Rhs rhs_;
  double tolerance_, t_, t_old_, h_ = 0, h_done_ = 0;
  bool interpolates_ = false;
  State y_, y_old_{}, y_new_;
  std::array<State, 16> K_{};
  std::array<State, 7> F_;
};
