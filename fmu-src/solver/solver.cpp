// Steps of the chosen engine, what is looked for inside each, and snapshots: what is remembered, as numbers, each
// checked before it is used.
#include "solver.hpp"

#include <algorithm>

#include "constant.hpp"

namespace solver {
namespace {

// (step, instant of an event in it) => latest end of the step after the event, s. An event right behind the start of
// its step, which most often began at another event, shows that the step was too long for the motion between the two: a
// small part of it is next.
double first_stop_after(const Step& step, double t) {
  CONSTANT(double, behind, 1e-6, "of the step", "an event nearer to the start of its step is right behind it");
  CONSTANT(double, part, 1e-3, "of the step", "long enough to grow again within three steps");
  const double length = step.end - step.start;
  if (!(t - step.start < behind * length)) return never;
  return t + std::fmax(part * length, 0.5 * rounding_at(t));
}

}  // namespace

bool Solver::start(const Problem& problem, Method method, double t, const double* y) {
  pending_ = Outcome::failed;
  problem_ = {};
  runge_kutta_ = {};
  collocation_ = {};
  step_ = {};  // nothing that is saved is left of an earlier solution
  std::fill_n(values_, max_watched, 0.0);
  counters_ = {};
  counters_.restarts = -1;  // the restart below does not count
  return restart(problem, method, t, y);
}

bool Solver::restart(const Problem& problem, Method method, double t, const double* y) {
  const bool at_event = pending_ == Outcome::event && t == known_until_;
  first_stop_ = at_event ? first_stop_after(step_, t) : never;
  const bool rests_on = rests_in_law() && problem.steep;
  problem_ = problem;
  if (!rests_on) method_ = method;
  known_until_ = t;
  fallen_ = 0;
  ++counters_.restarts;
  pending_ = Outcome::failed;
  failure_ = nullptr;
  step_.set_point(t, y, problem_.states);
  if (!engine().start(problem_)) return false;
  resume();
  return true;
}

void Solver::drop() {
  problem_ = {};
  pending_ = Outcome::failed;
  failure_ = not_started;
}

void Solver::resume() {
  pending_ = Outcome::stepped;
  double y[max_states];
  read(known_until_, y);
  for (int i = 0; i < problem_.watched_count; ++i) {
    const Watched& watched = problem_.watched[i];
    if (watched.quick) continue;
    ++counters_.roots;
    values_[i] = watched.value(problem_.owner, watched.event, known_until_, y);
  }
}

bool Solver::reaches(double t) const { return known_until_ >= t - rounding_at(t); }

Outcome Solver::step(double stop) {
  if (pending_ != Outcome::stepped) return pending_;
  const double from = known_until_;
  if (known_until_ == step_.end && !make_step(std::fmin(stop, first_stop_))) return pending_ = Outcome::failed;
  known_until_ = step_.end;
  if (step_.end > step_.start) look_for_events(from);
  return pending_;
}

bool Solver::make_step(double stop) {
  first_stop_ = never;
  // Where the stop time differs from the time reached by rounding only, the solution is moved there.
  if (stop > known_until_ && reaches(stop)) {
    step_.set_point(stop, step_.y_end, problem_.states);
    return engine().start(problem_);
  }
  if (method_ == Method::runge_kutta && runge_kutta_.rests()) {
    method_ = Method::collocation;
    if (!engine().start(problem_)) return false;
  }
  step_.start = step_.end;
  std::copy_n(step_.y_end, max_states, step_.y_start);
  step_.inside_at = 0;
  step_.degree = Step::unknown;
  const bool done = engine().advance(problem_, stop, &counters_, &step_);
  if (done) {
    ++counters_.steps;
  } else {
    step_.end = step_.start;
    std::copy_n(step_.y_start, max_states, step_.y_end);
  }
  return done;
}

void Solver::expand() const {
  if (step_.degree == Step::unknown && step_.end > step_.start) engine().expand(problem_, &step_);
}

// Looks from `from` to the end of the step for the first event.
void Solver::look_for_events(double from) {
  double instants[max_extremes];
  const int count = problem_.extremes ? problem_.extremes(problem_.owner, from, step_.end, instants) : 0;
  const std::span<const double> extremes(instants, static_cast<std::size_t>(count));
  for (int i = 0; i < problem_.watched_count; ++i) {
    const Watched& watched = problem_.watched[i];
    const Search search = {problem_, step_, watched, extremes, watched.quick ? &counters_.rhs : &counters_.roots};
    Sample lo = {from, values_[i]}, hi = {};
    if (watched.quick) {
      if (!comes_near(search)) continue;
      expand();
      lo = search.sample(from);
    } else {
      hi = search.sample(step_.end, step_.y_end);
      values_[i] = hi.g;
      if (extremes.empty() && is_far(search, lo, hi)) continue;
      expand();
    }
    if (hi.t != known_until_) hi = search.sample(known_until_);
    const auto fall = search.find_first_fall(lo, hi);
    if (!fall) continue;
    known_until_ = *fall;
    fallen_ = i;
    pending_ = Outcome::event;
  }
}

// Whether a quick function may fall. Where an input has an extreme inside the step, the function is evaluated there
// too, because none of the step's evaluations may have come near it.
bool Solver::comes_near(const Search& search) {
  if (step_.least_margin < problem_.near) return true;
  if (!search.extremes.empty()) expand();
  const auto is_near = [&](double t) { return t < known_until_ && search.sample(t).g < problem_.near; };
  return std::any_of(search.extremes.begin(), search.extremes.end(), is_near);
}

// Most steps are far from an event, which a value inside the step that is known anyway is enough to show.
bool Solver::is_far(const Search& search, Sample lo, Sample hi) const {
  if (!(step_.inside_at > 0) || lo.t != step_.start) return false;
  const double t = step_.start + step_.inside_at * (step_.end - step_.start);
  return Search::stays_above(lo, search.sample(t, step_.y_inside), hi);
}

void Solver::read(double t, double* y) const {
  t = std::clamp(t, step_.start, known_until_);
  const double rounding = rounding_at(t);
  if (t > step_.start + rounding && t < step_.end - rounding) expand();
  step_.read(t, 0, problem_.states, y);
}

// Fields are written only when they are read; a solver that is saved stays as it is, but for counts above the largest
// that is saved, at which they stay.
void Solver::visit(support::Archive& archive) {
  bool rests = rests_in_law();
  archive.count(rests, 0, problem_.steep && !problem_.turning ? 1 : 0);
  if (rests) method_ = Method::collocation;
  step_.visit(archive, problem_.states);
  archive.range(known_until_, step_.start, step_.end);
  archive.range(first_stop_, known_until_, never);
  archive.range(problem_.first_step, 0, never);  // of collocation, which may take over later; from where a start was
  archive.count(pending_, 0, static_cast<int>(Outcome::event));
  archive.count(fallen_, 0, std::max(problem_.watched_count - 1, 0));
  archive.numbers(values_, max_watched);
  for (long long* count : counters_.all()) archive.tally(*count);
  runge_kutta_.visit_size(archive);
  if (archive.fits()) engine().visit(archive, problem_, step_);
}

bool Solver::restore_history(const Problem& problem, Method method, support::Archive& archive) {
  problem_ = problem;
  method_ = method;
  step_ = {};
  runge_kutta_ = {};
  visit(archive);
  failure_ = nullptr;
  if (archive.is_sound()) return true;
  const double none[max_states] = {};
  step_.set_point(0, none, problem.states);  // reading it is harmless
  pending_ = Outcome::failed;
  return false;
}

}  // namespace solver
