// The problem that the owner of a solver states, and the counts that the solver keeps of it.
#pragma once

namespace solver {

inline constexpr int max_states = 12, max_bends = 16, max_degree = 12;

enum class Method : int { adams, bdf, runge_kutta };

// `owner` is handed back to each function. All functions are pure: the solver may ask at any (t, y) in any order.
struct Problem {
  int states;  // 1 to max_states
  void* owner;
  // y_dot = f(t, y). Returns the margin, the value of `boundary` at (t, y); NaN where the rates are not finite: the
  // solver then tries a smaller step.
  double (*derivative)(void* owner, double t, const double* y, double* y_dot);
  // weights[i] = 1 / (largest error of y_i), > 0, for a step whose error may be `share` times the tolerance of the
  // solution. A step is accepted where the root mean square of weight times local error is below one.
  void (*weights)(void* owner, double share, const double* y, double* weights);
  // Positive until the event; watched while armed.
  double (*event)(void* owner, double t, const double* y);
  // Positive inside the model.
  double (*boundary)(void* owner, double t, const double* y);
  // Instants strictly inside (t_lo, t_hi), ascending, at which a prescribed input has an extreme: between two of them
  // event and boundary have a simple shape. Returns their number, at most max_bends; null where inputs are constant.
  int (*bends)(void* owner, double t_lo, double t_hi, double* instants);
  double near;          // a step is searched for the boundary where a margin below this was seen in it
  double longest_step;  // s, > 0: at an unstable rest the error estimate is zero, and steps would grow without limit
  double share = 1;     // of the error that a step may otherwise make
};

// Of all steps since the first start. `rhs` counts every evaluation of f, those for difference quotients included.
struct Counters {
  long long steps, rhs, jacobians, roots, restarts;
};

}  // namespace solver
