// One step of DOP853 at one size: twelve evaluations and the error estimate; then the dense output.
//
// Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, second edition, sections II.4 to II.6.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <utility>

#include "dormand_prince.hpp"
#include "runge_kutta.hpp"

namespace solver {

namespace table = dormand_prince;

// The error that one step may make, as a fraction of the tolerance of the whole solution. Tuned on the wheel's scenes.
inline constexpr double share_of_tolerance = 0.03;

// Made of square roots, because pow may differ between platforms in the last bit.
inline double eighth_root(double x) { return std::sqrt(std::sqrt(std::sqrt(x))); }

template <int width>
class RungeKutta::Attempt {
 public:
  // f: its evaluations; h: its size, s.
  Attempt(const Problem& problem, Counters* counters, Step* step, double (*f)[max_states], double h)
      : problem_(problem), counters_(counters), step_(*step), f_(f), h_(h) {}

  void weigh() {
    std::fill_n(weights_, width, 0.0);
    problem_.weights(problem_.owner, share_of_tolerance * problem_.share, step_.y_start, weights_);
  }

  // f at t and y as stage i; returns the margin, NaN where the rates are not finite.
  double evaluate(int i, double t, const double* y) {
    ++counters_->rhs;
    const double margin = problem_.derivative(problem_.owner, t, y, f_[i]);
    if (margin < step_.lowest_margin) step_.lowest_margin = margin;
    return margin;
  }

  // From f and from its change over a short Euler step (II.4).
  double guess_size() {
    const double speed = norm(f_[0]), longest = problem_.longest_step;
    const double h = speed > 0 ? std::fmin(0.01 * norm(step_.y_start) / speed, 0.01 * longest) : 0;
    if (!(h > 0)) return longest;
    for (int i = 0; i < width; ++i) at_[i] = step_.y_start[i] + h * f_[0][i];
    if (std::isnan(evaluate(1, step_.start + h, at_))) return h;
    for (int i = 0; i < width; ++i) at_[i] = (f_[1][i] - f_[0][i]) / h;
    const double change = std::fmax(longest * speed, longest * longest * norm(at_));  // over the longest step
    return longest * std::fmin(1, eighth_root(0.01 / change));
  }

  // The error of the step over h in units of the weights; infinite where f is not finite.
  double try_size(double h) {
    h_ = h;
    const bool done = stage<1, table::a_1>(at_) && stage<2, table::a_2>(at_) && stage<3, table::a_3>(at_) &&
                      stage<4, table::a_4>(at_) && stage<5, table::a_5>(at_) && stage<6, table::a_6>(at_) &&
                      stage<7, table::a_7>(at_) && stage<8, table::a_8>(at_) && stage<9, table::a_9>(step_.y_inside) &&
                      stage<10, table::a_10>(at_) && stage<11, table::a_11>(at_);
    if (!done) return INFINITY;
    step_.inside_share = time_of<table::a_9>();
    end_step();
    return error();
  }

  void end_step() { advance<table::b>(step_.y_end); }

  bool evaluate_end(double* margin) { return !std::isnan(*margin = evaluate(12, step_.end, step_.y_end)); }

  // The three evaluations that only the dense output needs.
  bool evaluate_interior() {
    return stage<13, table::a_13>(at_) && stage<14, table::a_14>(at_) && stage<15, table::a_15>(at_);
  }

  // DOP853 gives the dense output as nested products, x = (t - start) / h:
  //   y = y_0 + x (p_0 + (1 - x) (p_1 + x (p_2 + (1 - x) (p_3 + x (p_4 + (1 - x) (p_5 + x p_6)))))).
  // Here it is sorted by the powers of s = x - 1.
  void expand() {
    const double h = h_;
    double p_3[width], p_4[width], p_5[width], p_6[width];
    combine<table::d_3>(p_3);
    combine<table::d_4>(p_4);
    combine<table::d_5>(p_5);
    combine<table::d_6>(p_6);
    auto& c = step_.c;
    for (int i = 0; i < width; ++i) {
      const double p_0 = step_.y_end[i] - step_.y_start[i], p_1 = h * f_[0][i] - p_0;
      const double p_2 = 2 * p_0 - h * (f_[0][i] + f_[12][i]);
      c[0][i] = step_.y_end[i];
      c[1][i] = h * f_[12][i];
      c[2][i] = (p_3[i] + p_4[i]) - (p_1 + 2 * p_2);
      c[3][i] = (2 * p_3[i] + 3 * p_4[i]) - (p_2 + p_5[i] + p_6[i]);
      c[4][i] = (p_3[i] + 3 * p_4[i]) - (3 * p_5[i] + 4 * p_6[i]);
      c[5][i] = p_4[i] - (3 * p_5[i] + 6 * p_6[i]);
      c[6][i] = -(p_5[i] + 4 * p_6[i]);
      c[7][i] = -p_6[i];
    }
    step_.degree = 7;
  }

 private:
  double norm(const double* x) const { return weighted_norm<width>(x, weights_, problem_.states); }

  // h sum of row_j f_j.
  template <const auto& row, std::size_t... j>
  void combine(double* sum, std::index_sequence<j...>) const {
    for (int i = 0; i < width; ++i) sum[i] = h_ * ((row[j].weight * f_[row[j].stage][i]) + ...);
  }
  template <const auto& row>
  void combine(double* sum) const {
    combine<row>(sum, std::make_index_sequence<std::size(row)>());
  }
  template <const auto& row>
  void advance(double* y) const {
    double change[width];
    combine<row>(change);
    for (int i = 0; i < width; ++i) y[i] = step_.y_start[i] + change[i];
  }

  template <const auto& row>
  static constexpr double time_of() {
    double sum = 0;
    for (const table::Term& term : row) sum += term.weight;
    return sum;
  }
  template <int i, const auto& row>
  bool stage(double* y) {
    advance<row>(y);
    return !std::isnan(evaluate(i, step_.start + time_of<row>() * h_, y));
  }

  // Both estimates together, as DOP853 weighs them.
  double error() const {
    double e_3[width], e_5[width];
    combine<table::e_3>(e_3);
    combine<table::e_5>(e_5);
    const double high = norm(e_5), low = norm(e_3);
    return high == 0 ? 0 : high * high / std::sqrt(high * high + 0.01 * low * low);
  }

  const Problem& problem_;
  Counters* counters_;
  Step& step_;
  double (*f_)[max_states];
  double h_;
  alignas(16) double weights_[width], at_[width] = {};
};

}  // namespace solver
