// Where a watched function falls through zero on the solver's dense output.
//
// CVODE's root finding sees a change of sign between the ends of a step. What it cannot see is a function that dips
// below zero and comes back within one step (a grazing slip, a wheel that leaves the ground for an instant).
#include <algorithm>
#include <cmath>
#include <limits>

#include "implementation.hpp"

namespace integrator {
namespace {

class OnDenseOutput {
 public:
  OnDenseOutput(const Integrator& solution, const System& system, Watched g)
      : solution_(solution), system_(system), g_(g) {}
  double operator()(double t) const {
    double y[max_states];
    solution_.read(t, y);
    return g_(system_.owner, t, y);
  }

 private:
  const Integrator& solution_;
  const System& system_;
  Watched g_;
};

double resolution(const Bracket& b) {
  return 4 * std::numeric_limits<double>::epsilon() * (std::fabs(b.t_hi) + (b.t_hi - b.t_lo));
}

// Illinois variant of false position, halving where it stalls: g(t_lo) >= 0 > g(t_hi). Returns the far end.
double fall_through(const OnDenseOutput& g, Bracket b) {
  double weight_lo = 1, weight_hi = 1;
  for (int i = 0; i < 200 && b.t_hi - b.t_lo > resolution(b); ++i) {
    const double lo = weight_lo * b.g_lo, hi = weight_hi * b.g_hi;
    double t = i % 3 == 2 ? 0.5 * (b.t_lo + b.t_hi) : b.t_lo + (b.t_hi - b.t_lo) * (lo / (lo - hi));
    t = std::clamp(t, b.t_lo + 0.25 * resolution(b), b.t_hi - 0.25 * resolution(b));
    const double value = g(t);
    if (value < 0) {
      b.t_hi = t, b.g_hi = value, weight_hi = 1, weight_lo *= 0.5;
    } else {
      b.t_lo = t, b.g_lo = value, weight_lo = 1, weight_hi *= 0.5;
    }
  }
  return b.t_hi;
}

// Ternary search for a value below zero inside the step; false where the minimum stays above.
bool find_dip(const OnDenseOutput& g, const Bracket& step, double* t_below) {
  double a = step.t_lo, b = step.t_hi;
  for (int i = 0; i < 40 && b - a > 1e-6 * (step.t_hi - step.t_lo); ++i) {
    const double left = a + (b - a) * 0.382, right = b - (b - a) * 0.382;
    const double g_left = g(left), g_right = g(right);
    if (std::fmin(g_left, g_right) < 0) {
      *t_below = g_left < 0 ? left : right;
      return true;
    }
    (g_left < g_right ? b : a) = g_left < g_right ? right : left;
  }
  return false;
}

// Whether g may fall below zero inside a step at whose ends it does not: a parabola through start, middle and end
// bottoms out between them far below the end values, or g starts from an end near zero downwards.
bool may_dip(const OnDenseOutput& g, const Bracket& step, double g_mid) {
  const double bend = 0.5 * (step.g_lo + step.g_hi) - g_mid, slope = 0.5 * (step.g_hi - step.g_lo);
  const double lower = std::fmin(step.g_lo, step.g_hi), upper = std::fmax(g_mid, std::fmax(step.g_lo, step.g_hi));
  if (bend > 0 && std::fabs(slope) < 2 * bend && g_mid - slope * slope / (4 * bend) < 0.25 * lower) return true;
  constexpr double close = 0.02;
  if (lower > close * upper) return false;
  const double inside = close * (step.t_hi - step.t_lo);
  return g(step.g_lo < step.g_hi ? step.t_lo + inside : step.t_hi - inside) < lower;
}

}  // namespace

bool find_first_zero(const Integrator& solution, const System& system, Watched g, const Bracket& step, double* t_zero) {
  if (step.g_lo < 0) return *t_zero = step.t_lo, true;
  const OnDenseOutput on_step(solution, system, g);
  Bracket first = step;
  const double t_mid = 0.5 * (step.t_lo + step.t_hi), g_mid = on_step(t_mid);
  if (g_mid < 0) {
    first.t_hi = t_mid, first.g_hi = g_mid;
  } else if (step.g_hi >= 0) {
    if (!may_dip(on_step, step, g_mid) || !find_dip(on_step, step, &first.t_hi)) return false;
    first.g_hi = on_step(first.t_hi);
  }
  *t_zero = fall_through(on_step, first);
  return true;
}

}  // namespace integrator
