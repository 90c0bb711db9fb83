// The last step of a solution, whichever engine made it, and its dense output: one Taylor polynomial about the end.
//
// Arrays have max_states entries. Loops run over `width`, the problem's number of states as a constant.
#pragma once

#include <cmath>
#include <limits>

#include "problem.hpp"

namespace solver {

inline constexpr double never = std::numeric_limits<double>::infinity();

// Two times closer than this are the same instant, s.
inline double rounding_at(double t) { return 8 * std::numeric_limits<double>::epsilon() * std::fabs(t); }

// Root mean square of weight times entry: even and odd ones apart, which the processor sums side by side.
template <int width>
double weighted_norm(const double* x, const double* weights) {
  double even = 0, odd = 0;
  for (int i = 0; i < width; i += 2) {
    even += (x[i] * weights[i]) * (x[i] * weights[i]);
    odd += (x[i + 1] * weights[i + 1]) * (x[i + 1] * weights[i + 1]);
  }
  return std::sqrt((even + odd) / width);
}

struct Step {
  double start, end;  // s
  alignas(16) double y_start[max_states], y_end[max_states];
  double lowest_margin;  // of the evaluations in the step
  // An approximation of y at start + inside_share (end - start), known without further work; share 0 where there is
  // none.
  double inside_share;
  alignas(16) double y_inside[max_states];
  // y(t) = sum of c_k s^k, s = (t - end) / (end - start) from -1 to 0; degree -1: not computed yet.
  int degree;
  alignas(16) double c[max_degree + 1][max_states];

  // A step of no length: y is known at t alone. y may be y_end.
  void set_point(double t, const double* y, int states);

  // y (states entries) at t inside the step; at its ends, up to a few roundings of t, what is kept there.
  void read(double t, int states, double* y) const;
};

}  // namespace solver
