// Numerical differentiation of several functions of one quantity x at once, by difference quotients of fourth order.
// Without physics: slopes.cpp has the functions.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "constant.hpp"

namespace wheel {

CONSTANT(double, first_part, 1e-3, "of the scale", "a step in which an error of fourth order is that of rounding");

// Four places, in steps from x, and two sets of weights of f there. The first gives the slope, exactly for polynomials
// of degree four. The second shows a bend, by third and fourth differences: their sum about x, and with half of the
// third to one side, where a limit is near.
struct Stencil {
  int places[4];
  double weights[4], bend[4];
};
inline constexpr Stencil about_x = {{-2, -1, 1, 2}, {1.0 / 12, -8.0 / 12, 8.0 / 12, -1.0 / 12}, {0.5, -3, -5, 1.5}};
inline constexpr Stencil above_x = {{1, 2, 3, 4}, {4, -3, 4.0 / 3, -1.0 / 4}, {-2.5, 4.5, -3.5, 1}};
inline constexpr Stencil below_x = {{-1, -2, -3, -4}, {-4, 3, -4.0 / 3, 1.0 / 4}, {-2.5, 4.5, -3.5, 1}};

// Of `count` functions f: (x) => std::optional of their values, none where x has none.
template <std::size_t count>
class Quotients {
 public:
  using Values = std::array<double, count>;

  // With steps of h about x.
  template <class F>
  void take(double x, double h, const F& f) {
    if (find_centre(x, f)) step(about_x, x, h, f);
  }

  // With smaller and smaller steps for what bends within the first, as the forces of a small spin or slip do, until
  //   all derivatives are exact;
  //   the step is as small as rounding;
  //   none of the first steps is possible: false.
  // scale: of x.
  template <class F>
  bool refine(double x, double scale, const F& f) {
    constexpr double finest = std::numeric_limits<double>::epsilon();
    CONSTANT(double, finest_first, 1e-10, "of the scale", "where no larger step is possible, it is at its limit");
    if (!find_centre(x, f)) return false;
    double part = first_part;
    while (part > (steps_ > 0 ? finest : finest_first) && !settle(scale)) {
      step(about_x, x, part * scale, f) || step(above_x, x, part * scale, f) || step(below_x, x, part * scale, f);
      part *= 0.1;
    }
    return steps_ > 0;
  }

  const Values& values() const { return values_; }  // at x
  const Values& slopes() const { return slopes_; }

 private:
  // The values at x itself; false where there are none.
  template <class F>
  bool find_centre(double x, const F& f) {
    const std::optional<Values> centre = f(x);
    if (centre) values_ = *centre;
    return centre.has_value();
  }

  // False where one of the places has no values. Of several steps, each derivative is that with the least error.
  // Differences from the value at x itself, so that what does not depend on x has the derivative zero.
  template <class F>
  bool step(const Stencil& stencil, double x, double h, const F& f) {
    Values quotient = {}, bend = {};
    for (int k = 0; k < 4; ++k) {
      const std::optional<Values> beside = f(x + stencil.places[k] * h);
      if (!beside) return false;
      for (std::size_t i = 0; i < count; ++i) {
        quotient[i] += stencil.weights[k] * ((*beside)[i] - values_[i]) / h;
        bend[i] += stencil.bend[k] * ((*beside)[i] - values_[i]) / h;
      }
    }
    for (std::size_t i = 0; i < count; ++i) {
      const double error = error_of(quotient[i], bend[i], x, values_[i], h);
      if (steps_ > 0 && (exact_[i] || error >= errors_[i])) continue;
      slopes_[i] = quotient[i];
      errors_[i] = error;
    }
    ++steps_;
    return true;
  }

  // The bend of a smooth function is of the order h^2, and the error is of the order h^4. So the error is about the
  // square of the bend, over the slope. A bend of zero shows nothing, and leaves rounding alone.
  static double error_of(double slope, double bend, double x, double value, double h) {
    const double size = std::fabs(slope);
    const double rounding = std::numeric_limits<double>::epsilon() * (std::fabs(value) + std::fabs(x) * size) / h;
    return (bend == 0 ? 0 : bend * bend / std::fmax(size, rounding)) + rounding;
  }

  // Marks the derivatives that are exact; true if all are.
  bool settle(double scale) {
    CONSTANT(double, relative, 1e-11, "1", "error of a derivative that counts as exact");
    if (steps_ == 0) return false;
    for (std::size_t i = 0; i < count; ++i)
      exact_[i] |= errors_[i] <= relative * (std::fabs(slopes_[i]) + std::fabs(values_[i]) / scale);
    return std::all_of(exact_.begin(), exact_.end(), [](bool of) { return of; });
  }

  int steps_ = 0;
  Values values_ = {}, slopes_ = {}, errors_ = {};
  std::array<bool, count> exact_ = {};  // smaller steps are of no use, whatever other functions need
};

}  // namespace wheel
