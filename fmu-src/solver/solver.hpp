// One initial-value problem y' = f(t, y) and its solution step by step: dense output, events, endings, snapshots.
//
// Engines behind one interface (step.hpp): CVODE's Adams and BDF, DOP853, and collocation.
// Independent of wheel and FMI. Time is that of the owner's clock, s. Steps never see the times at which results are
// read, so the communication grid cannot change a bit of the solution; only a stop time of the owner cuts a step short.
#pragma once

#include "collocation.hpp"
#include "cvode_engine.hpp"
#include "problem.hpp"
#include "runge_kutta.hpp"
#include "search.hpp"
#include "step.hpp"

namespace solver {

// stepped: one step was made;  event: a watched function, event(), fell below zero at known_until();
// failed: see failure(); the solution stays known until known_until().
enum class Outcome { stepped, event, failed };

class Solver {
 public:
  Solver() = default;
  Solver(const Solver&) = delete;  // it points to its engines
  Solver& operator=(const Solver&) = delete;

  // Starts, or starts anew, from y at time t (s); history is dropped. The first start sets the counters to zero, later
  // ones go on counting (`restarts` counts all but the first). Runge-Kutta keeps the step size that it wanted last.
  // Where a steep state rests, collocation takes over from it, until a start without one. False where SUNDIALS could
  // not be set up: failure().
  [[nodiscard]] bool start(const Problem& problem, Method method, double t, const double* y);
  [[nodiscard]] bool restart(const Problem& problem, Method method, double t, const double* y);

  // The solution, the problem and its owner are not needed any more; nothing may be read until the next start.
  void drop();

  // After an event that changes nothing of the motion, only what is watched: the same step goes on.
  void resume();

  // Runge-Kutta and collocation: the first step after a restart is at most dt, s (the time between the last two
  // changes). Two changes at the same instant limit nothing.
  void limit_first_step(double dt) {
    const bool counts = dt > rounding_at(known_until_);
    runge_kutta_.limit_first_step(counts ? dt : 0);
    if (counts) collocation_.limit_first_step(dt);
  }

  // One internal step, or the rest of one that was resumed. After an event the owner
  // restarts from there, resumes or ends; until then the step is that event again.
  // A new step ends at `stop`, s, at the latest; one that would end within a few roundings of it ends there. CVODE
  // starts anew at a stop: the short step would leave a history over nodes that lie close together, which rounding
  // ruins.
  [[nodiscard]] Outcome step(double stop = never);

  // Whether y(t) is known: known_until() is at t, up to a few roundings of t, or past it.
  bool reaches(double t) const;

  // (t) => y, step_start() <= t <= known_until(), clamped; t within a few roundings of an end is that end.
  void read(double t, double* y) const;

  // With its polynomial.
  const Step& last_step() {
    expand();
    return step_;
  }
  double step_start() const { return step_.start; }
  double known_until() const { return known_until_; }
  int event() const { return problem_.watched[fallen_].event; }
  const char* failure() const { return failure_ ? failure_ : engine().failure(); }
  const Counters& counters() const { return counters_; }

  // Snapshot: the complete history as numbers of 8 bytes; restored, the solution goes on bit-identically. It is
  // the last part of an archive; false where a number is out of its bounds (no solution then until start).
  void save_history(support::Archive& archive) { visit(archive); }
  [[nodiscard]] bool restore_history(const Problem& problem, Method method, support::Archive& archive);

 private:
  static constexpr const char* not_started = "the solver was not started";

  Engine& engine() const { return *engines_[static_cast<int>(method_)]; }
  // Whether collocation solves a steep state, and not a slide.
  bool rests_in_law() const { return method_ == Method::collocation && problem_.steep && !problem_.turning; }
  bool make_step(double stop);
  void expand() const;
  void look_for_events(double from);
  bool comes_near(const Search& search);
  bool is_far(const Search& search, Sample lo, Sample hi) const;
  void visit(support::Archive& archive);

  Problem problem_ = {};
  Method method_ = Method::adams;
  Outcome pending_ = Outcome::failed;
  const char* failure_ = not_started;  // null: see the engine
  double known_until_ = 0;             // s
  int fallen_ = 0;                     // which of the watched functions fell below zero last
  double first_stop_ = never;          // s, latest end of the first step after a start
  double values_[max_watched] = {};    // of what is watched at each step, at its end or where the solution was resumed
  Counters counters_ = {};
  // The dense output of the last step is computed when it is first needed: a pure function of the step.
  mutable Step step_ = {};
  Cvode adams_{Method::adams}, bdf_{Method::bdf};
  RungeKutta runge_kutta_;
  Collocation collocation_;
  Engine* const engines_[4] = {&adams_, &bdf_, &runge_kutta_, &collocation_};  // in the order of Method
};

}  // namespace solver
