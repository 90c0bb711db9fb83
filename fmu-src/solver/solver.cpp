// Steps of the chosen engine, and what is looked for inside each.
#include "solver.hpp"

#include <algorithm>
#include <cmath>

#include "search.hpp"

namespace solver {

constexpr double never = std::numeric_limits<double>::infinity();

bool Solver::start(const Problem& problem, Method method, double t, const double* y, bool armed) {
  problem_ = problem;
  pending_ = Outcome::failed;
  runge_kutta_ = {};
  counters_ = {};
  counters_.restarts = -1;  // the first start is none
  return restart(method, t, y, armed);
}

bool Solver::restart(Method method, double t, const double* y, bool armed) {
  stop_time_ = time_to_look_again(t);
  method_ = method;
  known_until_ = event_time_ = t;
  ++counters_.restarts;
  if (!begin(t, y)) return pending_ = Outcome::failed, false;
  pending_ = Outcome::stepped;
  armed_ = armed;
  if (armed) ++counters_.roots, event_value_ = problem_.event(problem_.owner, t, y);
  return true;
}

bool Solver::begin(double t, const double* y) {
  if (method_ == Method::runge_kutta) return runge_kutta_.start(t, y, problem_.states, &step_), true;
  return cvode_.start(problem_, method_, t, y, &step_) || (failure_ = cvode_.failure(), false);
}

// After an event right behind the start of its step, most often another event: the step was too long to see the motion
// between them, and the next one has to be shorter. Its latest end, s.
double Solver::time_to_look_again(double t) const {
  const double length = step_.end - step_.start;
  if (pending_ != Outcome::event || t != event_time_ || !(t - step_.start < 1e-6 * length)) return never;
  return t + std::fmax(1e-3 * length, 0.5 * rounding_at(t));
}

bool Solver::reaches(double t) const { return known_until_ >= t - rounding_at(t); }

bool Solver::advance(double stop) {
  if (method_ == Method::runge_kutta)
    return runge_kutta_.advance(problem_, stop, &counters_, &step_) || (failure_ = runge_kutta_.failure(), false);
  return cvode_.advance(problem_, stop, &counters_, &step_) || (failure_ = cvode_.failure(), false);
}

Outcome Solver::step() {
  if (pending_ != Outcome::stepped) return pending_;
  const double stop = stop_time_;
  stop_time_ = never;
  // The stop time differs from the time reached by rounding only.
  if (stop > known_until_ && reaches(stop)) {
    double y[max_states];
    std::copy_n(step_.y_end, max_states, y);
    if (!begin(stop, y)) return pending_ = Outcome::failed;
    known_until_ = stop;
    return Outcome::stepped;
  }
  if (!advance(stop)) return pending_ = Outcome::failed;
  ++counters_.steps;
  known_until_ = step_.end;
  watch_event();
  watch_boundary();
  return pending_;
}

void Solver::expand(Counters* counters) const {
  method_ == Method::runge_kutta ? runge_kutta_.expand(problem_, counters, &step_)
                                 : cvode_.expand(problem_.states, &step_);
}

// Whether an input has an extreme in the last step.
bool Solver::bends_inside() const {
  double instants[max_bends];
  return problem_.bends && problem_.bends(problem_.owner, step_.start, step_.end, instants) > 0;
}

void Solver::watch_event() {
  if (!armed_) return;
  const Sample lo = {step_.start, event_value_};
  const auto value = [&](double t, const double* y) {
    ++counters_.roots;
    return Sample{t, problem_.event(problem_.owner, t, y)};
  };
  const Sample hi = value(step_.end, step_.y_end);
  event_value_ = hi.g;
  // Most steps are far from an event, which a value inside the step that is known anyway is enough to tell.
  if (step_.inside_share > 0 && !bends_inside() &&
      Search::stays_above(lo, value(step_.start + step_.inside_share * (step_.end - step_.start), step_.y_inside), hi))
    return;
  expand(&counters_);
  double t;
  if (Search(problem_, step_, problem_.event, &counters_.roots).find_first_fall(lo, hi, &t)) end_at(t, Outcome::event);
}

// Watches the boundary as far as the step is valid. Where an input has an extreme inside the step, the boundary is
// evaluated there too, because none of the step's own evaluations may have come near it.
void Solver::watch_boundary() {
  double instants[max_bends], lowest = step_.lowest_margin;
  const int count = problem_.bends && lowest >= problem_.near
                        ? problem_.bends(problem_.owner, step_.start, known_until_, instants)
                        : 0;
  if (count > 0) expand(&counters_);
  const Search search(problem_, step_, problem_.boundary, &counters_.rhs);
  for (int i = 0; i < count; ++i) lowest = std::fmin(lowest, search.value(instants[i]));
  if (!(lowest < problem_.near)) return;
  expand(&counters_);
  double t;
  if (search.find_first_fall({step_.start, search.value(step_.start)}, {known_until_, search.value(known_until_)}, &t))
    end_at(t, Outcome::ended);
}

void Solver::end_at(double t, Outcome why) {
  known_until_ = event_time_ = t;
  pending_ = why;
}

void Solver::read(double t, double* y) const {
  t = std::clamp(t, step_.start, known_until_);
  Counters uncounted = {};  // else the counts would depend on the instants that are read
  const double rounding = rounding_at(t);
  if (t > step_.start + rounding && t < step_.end - rounding) expand(&uncounted);
  step_.read(t, problem_.states, y);
}

bool Solver::first_fall(double (*g)(void*, double, const double*), double sign, double t_lo, double t_hi,
                        double* t) const {
  Counters uncounted = {};
  expand(&uncounted);
  const Search search(problem_, step_, g, &uncounted.roots, sign);
  return search.find_first_fall({t_lo, search.value(t_lo)}, {t_hi, search.value(t_hi)}, t);
}

}  // namespace solver
