// The problem that the owner of a solver states, and the counts that the solver keeps of it.
#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <span>

namespace solver {

inline constexpr int max_states = 10, max_extremes = 20, max_degree = 12, max_watched = 13;

enum class Method : int { adams, bdf, runge_kutta, collocation };

// What follows from an event, for the owner to decide: the motion ends there; it goes on from there under other rates;
// or nothing of it changes.
enum class Consequence : int { ends, bends, goes_on };

// A function whose value, its margin, falls below zero at an event: the solver finds the first such instant and stops
// there.
struct Watched {
  int event;  // the owner's number of it, 0 to max_watched
  double (*value)(void* owner, int event, double t, const double* y);
  // Whether its margin comes with the rates, in the least one that `derivative` returns: then it is looked at only in
  // steps in which that came near zero, else at each step. Quick margins must be scaled alike.
  bool quick;
  int state = -1;  // the only one that `value` reads; below zero: it reads all
};

// A state that settles at once where its rate vanishes, times y[speed] if there is a speed: the rate itself falls
// steeply with the state, or it is turning / y[speed] + ... and the speed may be small.
// (t, y, values of the state) => slopes of the rate, or of the turning, by the state; `others`, zeros before, without a
// speed: by how much the rate of each other state changes with this one's.
struct Settling {
  static constexpr int none = -1;
  int state, speed;
  void (*slopes)(void* owner, double t, const double* y, std::span<const double> values, double* slopes,
                 double* others);
  double width = INFINITY;  // the rate bends within a few widths about zero
};

// `owner` is passed to each function. The solver may ask at any (t, y) in any order, and from a start or a resume to
// the next event the answer depends on nothing else.
struct Problem {
  int states;  // 8, or 10 for collocation alone: the length of loops, known at compile time
  void* owner;
  // (t, y) => y_dot = f(t, y); returns the least of the quick margins, infinite if there is none; NaN where the rates
  // are not finite: the solver then tries a smaller step.
  double (*derivative)(void* owner, double t, const double* y, double* y_dot);
  // (share, y) => weights[i] = 1 / (largest error of y_i), > 0, for a step whose error may be `share` times the
  // tolerance of the solution. A step is accepted where the root mean square of weight times local error is below one.
  void (*weights)(void* owner, double share, const double* y, double* weights);
  // Of two events at the same instant the later one in the list counts.
  Watched watched[max_watched];
  int watched_count;
  // Instants strictly inside (t_lo, t_hi), ascending, at which a prescribed input has an extreme: between two of them
  // the watched functions have a simple shape. Returns their number, at most max_extremes; null where inputs are
  // constant.
  int (*extremes)(void* owner, double t_lo, double t_hi, double* instants);
  double near;          // quick margins below this are near zero
  double longest_step;  // s, > 0: at an unstable rest the error estimate is zero, and steps would grow without limit
  std::optional<Settling> steep;    // without a speed: DOP853 passes it by short steps, collocation solves it
  std::optional<Settling> turning;  // with one; for collocation alone, as first_step
  double first_step = INFINITY;     // s, > 0: limit of the first step, since no point is at the start
  double share = 1;                 // of the error that a step may otherwise make

  // At most max_watched of them.
  void watch(const Watched& function) { watched[watched_count++] = function; }
};

// Of all steps since the first start. `rhs` counts the evaluations of f, those for difference quotients included but
// not those of a dense output, and of the quick functions that are watched; `roots` those of the others.
struct Counters {
  long long steps, rhs, jacobians, roots, restarts;

  std::array<long long*, 5> all() { return {&steps, &rhs, &jacobians, &roots, &restarts}; }
};

}  // namespace solver
