// A change of sign between the ends of a step is not enough: a function may dip below zero and come back within one
// step (a held wheel is released for an instant, a wheel leaves the ground for an instant). Most steps are far from any
// event, and the dense output costs three evaluations, so Solver::look_for_events asks in three stages.
//
// First, by numbers that are known anyway. A quick function comes with the rates, and Step::least_margin is the least
// of all quick values at the stages of the step: where it is above Problem::near, none is looked at, unless one is near
// at an extreme of an input (Solver::comes_near). Each of the other functions is evaluated at the end of the step. Its
// value at the start is kept from the step before (Solver::values_), and the method leaves a state inside the step
// (Step::inside_at) for a third sample. If no input has an extreme there, a parabola through the three that is well
// above zero is enough (Solver::is_far).
//
// Then, on the dense output, find_first_fall goes through the pieces between the extremes of inputs, in which g has a
// simple shape. It halves them while the parabola through three samples does not show that g stays above zero
// (stays_above), a fixed number of times at most.
//
// Last, between a sample at or above zero and one below it, fall_through finds the instant.
#include "search.hpp"

#include <algorithm>
#include <cmath>

#include "constant.hpp"

namespace solver {
namespace {

CONSTANT(int, most_halvings, 7, "halvings", "the narrowest dip that is looked for lasts 1/128 of a step");
CONSTANT(int, most_samples, 48, "evaluations", "between two extremes: a noisy function costs no more than four steps");
// How far g may lie below the parabola through three samples.
CONSTANT(double, of_bend, 0.25, "1", "of its bend: what a fourth sample of smooth functions shows");
CONSTANT(double, of_range, 0.1, "1", "of its range: the same for functions without a bend");

// g = lo.g + x (slope + bend (x - middle)), x = (t - lo.t) / (hi.t - lo.t), through three samples.
struct Parabola {
  double middle, slope, bend;
  Parabola(Sample lo, Sample mid, Sample hi) {
    middle = (mid.t - lo.t) / (hi.t - lo.t);
    slope = (mid.g - lo.g) / middle;
    bend = (hi.g - mid.g) / (1 - middle) - slope;
  }
  // x of the minimum; outside (0, 1) where an end is the lowest.
  double lowest_at() const { return bend > 0 ? 0.5 * (middle - slope / bend) : -1; }
  double value(double g_lo, double x) const { return g_lo + x * (slope + bend * (x - middle)); }
};

}  // namespace

Sample Search::sample(double t) const {
  double y[max_states];
  watched.state < 0 ? step.read(t, 0, problem.states, y) : step.read(t, watched.state, 1, y);
  return sample(t, y);
}

bool Search::stays_above(Sample lo, Sample mid, Sample hi) {
  double lowest = std::fmin(mid.g, std::fmin(lo.g, hi.g));
  if (!(lowest > 0)) return lowest == 0 && lo.g == 0 && mid.g == 0 && hi.g == 0;
  const Parabola p(lo, mid, hi);
  const double x = p.lowest_at(), range = std::fmax(mid.g, std::fmax(lo.g, hi.g)) - lowest;
  if (x > 0 && x < 1) lowest = std::fmin(lowest, p.value(lo.g, x));
  return lowest > of_bend * std::fabs(p.bend) + of_range * range;
}

// (three samples, lo.g >= 0) => the first one below zero that can be found, and the one before it. An interval is left
//   where a parabola shows that g stays above zero;
//   where it has been halved `depth` times, spans a few roundings of time, or the budget of samples is spent: what its
//   three samples show counts.
std::optional<Search::Fall> Search::look(Sample lo, Sample mid, Sample hi, int depth, int* budget) const {
  if (mid.g >= 0 && stays_above(lo, mid, hi)) return {};
  const bool deeper = depth > 0 && *budget >= 2 && hi.t - lo.t > 8 * rounding_at(hi.t);
  if (!deeper) {
    if (mid.g < 0) return Fall{lo, mid};
    return hi.g < 0 ? std::optional(Fall{mid, hi}) : std::nullopt;
  }
  --*budget;
  if (const auto fall = look(lo, sample(0.5 * (lo.t + mid.t)), mid, depth - 1, budget)) return fall;
  if (hi.g < 0) return Fall{mid, hi};
  const double x = Parabola(lo, mid, hi).lowest_at();
  const Sample low = x > 0 && x < 1 ? sample(lo.t + x * (hi.t - lo.t)) : mid;
  if (low.g < 0) return Fall{lo, low};
  --*budget;
  return look(mid, sample(0.5 * (mid.t + hi.t)), hi, depth - 1, budget);
}

std::optional<double> Search::find_first_fall(Sample lo, Sample hi) const {
  if (lo.g < 0) return lo.t;
  for (std::size_t i = 0; lo.t < hi.t; ++i) {
    const Sample end = i < extremes.size() && extremes[i] < hi.t ? sample(extremes[i]) : hi;
    // A whole step is divided first where a known value may have given rise to the search: elsewhere it may look
    // harmless.
    const bool whole = step.inside_at > 0 && lo.t == step.start && end.t == step.end;
    const Sample mid = sample(lo.t + (whole ? step.inside_at : 0.5) * (end.t - lo.t));
    int budget = most_samples;
    if (const auto fall = look(lo, mid, end, most_halvings, &budget)) return fall_through(fall->before, fall->below);
    lo = end;
  }
  return {};
}

// (lo.g >= 0 > hi.g) => the first instant known to be below zero, a few roundings past the root. Chandrupatla, Advances
// in Engineering Software 28 (1997) 145: inverse quadratic interpolation where it is safe, else halving, until
//   the interval spans a few roundings of time;
//   100 samples are taken, which none needs.
double Search::fall_through(Sample lo, Sample hi) const {
  Sample a = hi, b = lo, c = hi;  // a is the latest, b on the other side of the root
  double x = 0.5;
  for (int i = 0; i < 100; ++i) {
    const double width = std::fabs(b.t - a.t), finest = 0.5 * rounding_at(std::fmax(a.t, b.t)) / width;
    if (2 * finest >= 1) break;
    const Sample next = sample(a.t + std::clamp(x, finest, 1 - finest) * (b.t - a.t));
    if ((next.g < 0) == (a.g < 0)) {
      c = a;
    } else {
      c = b;
      b = a;
    }
    a = next;
    const double xi = (a.t - b.t) / (c.t - b.t), phi = (a.g - b.g) / (c.g - b.g);
    const bool safe = phi * phi < xi && (1 - phi) * (1 - phi) < 1 - xi;
    x = !safe
            ? 0.5
            : a.g / (b.g - a.g) * c.g / (b.g - c.g) + (c.t - a.t) / (b.t - a.t) * a.g / (c.g - a.g) * b.g / (c.g - b.g);
  }
  return a.g < 0 ? a.t : b.t;
}

}  // namespace solver
