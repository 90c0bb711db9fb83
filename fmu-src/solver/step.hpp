// The last step of a solution, its dense output, one Taylor polynomial about the end, and the engine that makes it: one
// interface for all methods.
//
// Arrays have max_states entries. Loops run over `width`, the problem's number of states as a constant.
#pragma once

#include <cmath>
#include <limits>

#include "bytes.hpp"
#include "problem.hpp"

namespace solver {

inline constexpr double never = std::numeric_limits<double>::infinity();

// Why an engine fails most often.
inline constexpr const char* step_too_small =
    "the step size became too small: extreme forces, or a communication step too long for a stiff link";

// (t) => two times closer than this are the same instant, s
inline double rounding_at(double t) { return 8 * std::numeric_limits<double>::epsilon() * std::fabs(t); }

// Made of square roots, because pow may differ between platforms in the last bit.
inline double eighth_root(double x) { return std::sqrt(std::sqrt(std::sqrt(x))); }

// (x, weights) => root mean square of weight times entry: even and odd ones apart, which the processor sums side by
// side. That of ten entries is taken over twelve, for which the shares of the tolerance were tuned.
template <int width>
double weighted_norm(const double* x, const double* weights) {
  double even = 0, odd = 0;
  for (int i = 0; i < width; i += 2) {
    even += (x[i] * weights[i]) * (x[i] * weights[i]);
    odd += (x[i + 1] * weights[i + 1]) * (x[i + 1] * weights[i + 1]);
  }
  return std::sqrt((even + odd) / (width == 8 ? 8 : 12));
}

// (c, s) => y = sum of c_k s^k, of `width` states from `first` on, even and odd powers apart: two Horner schemes that
// the processor can compute side by side. A master pays for this at each communication point.
template <int width, int row>
void evaluate(const double (*c)[row], int degree, double s, double* y, int first = 0) {
  const int even = degree - degree % 2, odd = degree - 1 + degree % 2;
  double sum[2][width] = {};
  for (int k = even; k >= 0; k -= 2)
    for (int i = 0; i < width; ++i) sum[0][i] = sum[0][i] * (s * s) + c[k][first + i];
  for (int k = odd; k > 0; k -= 2)
    for (int i = 0; i < width; ++i) sum[1][i] = sum[1][i] * (s * s) + c[k][first + i];
  for (int i = 0; i < width; ++i) y[i] = sum[0][i] + sum[1][i] * s;
}

struct Step {
  double start, end;  // s
  alignas(16) double y_start[max_states], y_end[max_states];
  double least_margin;  // of the quick ones, at the evaluations in the step
  // An approximation of y at start + inside_at (end - start), known without further work; 0 where there is
  // none.
  double inside_at;
  alignas(16) double y_inside[max_states];
  // y(t) = sum of c_k s^k, s = (t - end) / (end - start) from -1 to 0.
  static constexpr int unknown = -1;
  int degree;  // unknown: the polynomial is not computed yet
  alignas(16) double c[max_degree + 1][max_states];

  // A step of no length: y is known at t alone. y may be y_end.
  void set_point(double t, const double* y, int states);

  // What is saved of the step: all but its polynomial.
  void visit(support::Archive& archive, int states);

  // `count` states from `first` on (out, in their places in y) at t inside the step; at its ends, up to a few roundings
  // of t, what is kept there. All states, or one alone.
  void read(double t, int first, int count, double* y) const;
};

// Keeps what it needs from step to step; the step itself belongs to the solver.
class Engine {
 public:
  // The next step starts anew. False where the engine could not be set up: failure().
  [[nodiscard]] virtual bool start(const Problem& problem) = 0;

  // One step from the end of the last one, which `step` is moved to, up to `stop` (s) at the latest. False where none
  // is accepted: failure() gives the reason.
  [[nodiscard]] virtual bool advance(const Problem& problem, double stop, Counters* counters, Step* step) = 0;

  // The polynomial of the step, which is not known yet; of degree zero where rates inside the step are not finite.
  virtual void expand(const Problem& problem, Step* step) = 0;

  // All that is needed to go on after the step, which is this engine's, saved or read.
  virtual void visit(support::Archive& archive, const Problem& problem, const Step& step) = 0;

  const char* failure() const { return failure_; }

 protected:
  ~Engine() = default;
  const char* failure_ = nullptr;
};

}  // namespace solver
