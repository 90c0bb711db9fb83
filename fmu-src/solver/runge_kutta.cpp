// Steps of DOP853: which step sizes are tried, and what is kept for the next step.
//
// Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, second edition, sections II.4 to II.6.
#include "runge_kutta.hpp"

#include <algorithm>

#include "attempt.hpp"

namespace solver {
namespace {

constexpr int most_attempts = 40;

// A step is sized for an error of safety^8.
constexpr double safety = 0.9;

// A step that would reach the stop if it were longer by this factor is made longer and ends there. This avoids a tiny
// step, and adds at most 8 % to the step's error.
constexpr double stretch = 1.01;

}  // namespace

bool RungeKutta::start(const Problem& problem, double t, const double* y, Step* step) {
  step->set_point(t, y, problem.states);
  limit_ = 0;
  rates_ = 0;
  last_error_ = 0;
  return true;
}

// The error divided by h^8 changes along the motion, and is expected to change by the same factor once more
// (Gustafsson, ACM TOMS 20 (1994) 496: predictive step control). On the wheel hardly any step is then rejected.
double RungeKutta::next_size(double h, double error) {
  error = std::fmax(error, 1e-6);  // smaller errors, as after a step cut short, are mostly rounding
  const double trend = last_error_ > 0 ? (h / size_) * eighth_root(last_error_ / error) : 1;
  last_error_ = error;
  return h * std::clamp(safety / eighth_root(error) * std::clamp(trend, 0.5, 2.0), 0.2, 10.0);
}

// What `body` makes of an attempt as wide as the state.
template <class Body>
auto RungeKutta::with_attempt(const Problem& problem, Counters* counters, Step* step, const Body& body) {
  if (width_of(problem.states) == 8) return body(Attempt<8>(problem, counters, step, f_, size_));
  return body(Attempt<max_states>(problem, counters, step, f_, size_));
}

bool RungeKutta::advance(const Problem& problem, double stop, Counters* counters, Step* step) {
  return with_attempt(problem, counters, step,
                      [&](auto attempt) { return advance_wide(attempt, problem, stop, step); });
}

template <int width>
bool RungeKutta::advance_wide(Attempt<width>& attempt, const Problem& problem, double stop, Step* step) {
  step->start = step->end;
  std::copy_n(step->y_end, width, step->y_start);
  step->degree = -1;
  if (rates_ == 16)
    std::copy_n(f_[12], width, f_[0]);
  else
    margin_ = attempt.evaluate(0, step->start, step->y_start);
  failure_ = std::isnan(margin_) ? "the rates of the states are not finite" : nullptr;
  if (!failure_) {
    attempt.weigh();
    double& liked = liked_[problem.passage];
    if (liked == 0) liked = attempt.guess_size();
    failure_ = accept_step(attempt, problem.longest_step, stop, &liked, step);
  }
  limit_ = 0;
  if (!failure_) return true;
  rates_ = 0;
  step->end = step->start;
  std::copy_n(step->y_start, width, step->y_end);
  return false;
}

// Tries smaller and smaller steps until one is accepted. Null, or the reason why none was.
template <int width>
const char* RungeKutta::accept_step(Attempt<width>& attempt, double longest, double stop, double* liked, Step* step) {
  if (limit_ > 0) longest = std::fmin(limit_, longest);
  const double t = step->start;
  double h = std::fmin(*liked, longest);
  bool rejected = false;
  for (int attempts = 0; attempts < most_attempts; ++attempts) {
    const bool stops = t + stretch * h >= stop;
    if (stops) h = stop - t;
    const bool waits = stops || h == limit_;  // most often the problem changes where this step ends
    if (!stops && h <= rounding_at(t)) break;
    step->end = stops ? stop : t + h;
    step->lowest_margin = margin_;
    double error = attempt.try_size(h);
    if (error <= 1 && !waits && !(attempt.evaluate_end(&margin_) && attempt.evaluate_interior())) error = INFINITY;
    if (!(error <= 1)) {
      h = *liked = h * std::fmax(0.2, safety / eighth_root(error));
      rejected = true;
      continue;
    }
    const double next = next_size(h, error);
    // A step that was cut short shows little, so the size wanted before it is kept. After a rejection a step does not
    // grow.
    *liked = rejected ? std::fmin(h, next) : h < *liked ? std::fmax(*liked, next) : next;
    size_ = h;
    rates_ = waits ? 12 : 16;
    return nullptr;
  }
  return "the step size became too small";
}

void RungeKutta::expand(const Problem& problem, Counters* counters, Step* step) {
  if (rates_ < 12) return;
  with_attempt(problem, counters, step, [&](auto attempt) {
    double margin;
    if (rates_ == 12 && attempt.evaluate_end(&margin)) attempt.evaluate_interior();
    attempt.expand();
  });
}

// `rates` holds the evaluations of the last step that were made, 0, 12 or 16.
void RungeKutta::visit(support::Archive& archive, const Problem& problem, Step* step, bool active) {
  archive("step sizes of Runge-Kutta");
  for (double* size : {&liked_[0], &liked_[1], &limit_, &size_}) archive.range(*size, 0, archive.greatest);
  archive.range(last_error_, 0, 1);
  archive.number(margin_);
  archive("stages of Runge-Kutta").count(rates_, 0, 16);
  for (int k = 0; k < rates_; ++k) archive.numbers(f_[k], problem.states);
  if (active && archive.reads() && !fits(problem, step)) archive.refuse();
}

// Whether the restored numbers are those of the step, to the bit; then the step has its polynomial again.
bool RungeKutta::fits(const Problem& problem, Step* step) {
  if (rates_ == 0) return step->start == step->end;
  if (rates_ != 12 && rates_ != 16) return false;
  if (!(size_ > 0) || std::fabs(step->end - step->start - size_) > rounding_at(step->end)) return false;
  Step same = *step;
  with_attempt(problem, nullptr, &same, [](auto attempt) { attempt.end_step(); });
  const bool fits = std::equal(step->y_end, step->y_end + problem.states, same.y_end);
  *step = same;
  return fits;
}

}  // namespace solver
