// The wheel by DOP853 with everything inlined: what a hand-written program reaches. Called from Python
// (reports/native.py). The product's right-hand side and coefficients are compiled into this file; step control, error
// norm and dense output are those of SciPy's DOP853, with one tolerance for relative and absolute error.
//
// Exact friction as physics asks for it: a mode ends where its margin falls through zero on the dense output, and the
// next one starts there. Frames and names as in wheel_equations.h.
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

extern "C" {
#include "reduced.c"
}
#include "dormand_prince.hpp"

namespace {

namespace pair = solver::dormand_prince;
using State = std::array<double, WHEEL_REDUCED_STATES>;
constexpr int size = WHEEL_REDUCED_STATES;
constexpr long most_steps = 200000, most_events = 1000;

class Dop853 {
 public:
  Dop853(const WheelScene& of, const State& y, double tolerance) : scene(of), tolerance_(tolerance) { restart(0, y); }

  // From y at t, with the step size reached so far.
  void restart(double t, const State& y) {
    t_ = t_old_ = t;
    y_ = y;
    interpolates_ = false;
    evaluate(y_, f_[0]);
    if (h_ == 0) h_ = first_step();
  }

  // One accepted step. False: the step became too small.
  bool step() {
    if (t_ > t_old_) f_[0] = f_[12];
    for (bool rejected = false;; rejected = true) {
      if (h_ < 1e-14 * std::fmax(1, t_)) return false;
      try_step();
      const double error = step_error();
      const double factor = 0.9 * std::pow(error, -1.0 / 8);
      h_done_ = h_;
      h_ *= error < 1 ? (rejected ? std::fmin(1, factor) : std::fmin(10, factor)) : std::fmax(0.2, factor);
      if (error < 1) break;
    }
    ++steps;
    y_old_ = y_, y_ = y_new_;
    t_old_ = t_, t_ += h_done_;
    interpolates_ = false;
    return true;
  }

  // y(t) inside the last step; the three further stages are evaluated once per step, and only if asked for.
  State at(double t) {
    if (!interpolates_) prepare_interpolant();
    const double x = (t - t_old_) / h_done_;
    State y{};
    for (int i = 6; i >= 0; --i)
      for (int c = 0; c < size; ++c) y[c] = (y[c] + F_[i][c]) * (i % 2 ? 1 - x : x);
    for (int c = 0; c < size; ++c) y[c] += y_old_[c];
    return y;
  }

  double t() const { return t_; }
  double t_old() const { return t_old_; }
  const State& y() const { return y_; }
  WheelScene scene;
  long steps = 0, evaluations = 0;

 private:
  void evaluate(const State& y, State& y_dot) {
    derivative(&scene, y.data(), y_dot.data());
    ++evaluations;
  }

  // The sum of a row's terms, unrolled at compile time.
  template <const auto& row>
  State combine() const {
    State sum{};
    [&]<std::size_t... j>(std::index_sequence<j...>) {
      (([&] {
         for (int c = 0; c < size; ++c) sum[c] += row[j].weight * f_[row[j].stage][c];
       }()),
       ...);
    }(std::make_index_sequence<std::size(row)>());
    return sum;
  }

  template <int stage, const auto& row>
  void evaluate_stage(const State& from, double h) {
    State y = combine<row>();
    for (int c = 0; c < size; ++c) y[c] = from[c] + h * y[c];
    evaluate(y, f_[stage]);
  }

  void try_step() {
    evaluate_stage<1, pair::a_1>(y_, h_), evaluate_stage<2, pair::a_2>(y_, h_);
    evaluate_stage<3, pair::a_3>(y_, h_), evaluate_stage<4, pair::a_4>(y_, h_);
    evaluate_stage<5, pair::a_5>(y_, h_), evaluate_stage<6, pair::a_6>(y_, h_);
    evaluate_stage<7, pair::a_7>(y_, h_), evaluate_stage<8, pair::a_8>(y_, h_);
    evaluate_stage<9, pair::a_9>(y_, h_), evaluate_stage<10, pair::a_10>(y_, h_);
    evaluate_stage<11, pair::a_11>(y_, h_);
    const State increment = combine<pair::b>();
    for (int c = 0; c < size; ++c) y_new_[c] = y_[c] + h_ * increment[c];
    evaluate(y_new_, f_[12]);
  }

  double step_error() const {
    const State e_5 = combine<pair::e_5>(), e_3 = combine<pair::e_3>();
    double sum_5 = 0, sum_3 = 0;
    for (int c = 0; c < size; ++c) {
      const double scale = tolerance_ * (1 + std::fmax(std::fabs(y_[c]), std::fabs(y_new_[c])));
      sum_5 += e_5[c] / scale * (e_5[c] / scale);
      sum_3 += e_3[c] / scale * (e_3[c] / scale);
    }
    const double both = sum_5 + 0.01 * sum_3;
    if (both == 0) return 1e-9;
    const double error = h_ * sum_5 / std::sqrt(both * size);
    return std::isfinite(error) ? std::fmax(error, 1e-9) : 1e9;
  }

  // A guess from the size of y' alone; the first steps correct it.
  double first_step() const {
    double rate = 0;
    for (int c = 0; c < size; ++c) rate = std::fmax(rate, std::fabs(f_[0][c]) / (1 + std::fabs(y_[c])));
    return 0.5 * std::pow(tolerance_, 1.0 / 8) / std::fmax(rate, 1e-3);
  }

  void prepare_interpolant() {
    evaluate_stage<13, pair::a_13>(y_old_, h_done_), evaluate_stage<14, pair::a_14>(y_old_, h_done_);
    evaluate_stage<15, pair::a_15>(y_old_, h_done_);
    const State high[] = {combine<pair::d_3>(), combine<pair::d_4>(), combine<pair::d_5>(), combine<pair::d_6>()};
    for (int c = 0; c < size; ++c) {
      const double delta = y_[c] - y_old_[c];
      F_[0][c] = delta;
      F_[1][c] = h_done_ * f_[0][c] - delta;
      F_[2][c] = 2 * delta - h_done_ * (f_[12][c] + f_[0][c]);
      for (int i = 0; i < 4; ++i) F_[3 + i][c] = h_done_ * high[i][c];
    }
    interpolates_ = true;
  }

  double tolerance_, t_, t_old_, h_ = 0, h_done_ = 0;
  bool interpolates_ = false;
  State y_, y_old_{}, y_new_;
  std::array<State, 16> f_{};
  std::array<State, 7> F_;
};

// One solution on a grid of equal spacing.
class Solution {
 public:
  Solution(const WheelScene& scene, const State& y, double tolerance, double spacing, int points, double* rows)
      : solver_(scene, y, tolerance), spacing_(spacing), points_(points), rows_(rows) {
    exact_ = scene.friction.kind == WHEEL_ROLLING;
    if (exact_) solver_.scene.friction.sigma = y[3] > 0 ? 1 : -1;
    solver_.restart(0, y);
    write(y);
  }

  bool run(long* counts) {
    while (done_ < points_) {
      if (!solver_.step() || solver_.steps > most_steps || counts[2] > most_events) return false;
      const bool falls = exact_ && margin(solver_.y()) < 0;
      const double t = falls ? fall() : solver_.t();
      for (double next; done_ < points_ && (next = spacing_ * done_) <= t;) write(solver_.at(next));
      if (falls) change_mode(t), ++counts[2];
    }
    counts[0] = solver_.steps, counts[1] = solver_.evaluations;
    return true;
  }

 private:
  // X_O, theta, phi_dot, psi_dot
  void write(const State& y) {
    WheelKinematics k;
    pose(&solver_.scene.wheel, y.data(), &k);
    const double row[] = {k.X_O, k.theta, k.phi_dot, k.psi_dot};
    for (int i = 0; i < 4; ++i) rows_[4 * done_ + i] = row[i];
    ++done_;
  }

  // The moment that would hold omega_z = 0.
  double holding(const State& y, double* spare) const {
    WheelScene held = solver_.scene;
    held.friction.kind = WHEEL_HELD;
    WheelDynamics now;
    dynamics(&held, y.data(), &now);
    *spare = held.wheel.s * std::fmax(now.lambda[2], 0) - std::fabs(now.tau);
    return now.tau;
  }

  double margin(const State& y) const {
    const WheelFriction& friction = solver_.scene.friction;
    double spare = friction.sigma * y[3];
    if (friction.kind == WHEEL_HELD) holding(y, &spare);
    return spare;
  }

  // The margin's fall through zero in the last step (Illinois). A slip starts at margin zero: left out.
  double fall() {
    double hi = solver_.t(), g_hi = margin(solver_.y()), lo = hi, g_lo = -1;
    for (int i = 0; i < 40 && g_lo <= 0; ++i) {
      lo = solver_.t_old() + 0.5 * (lo - solver_.t_old());
      g_lo = margin(solver_.at(lo));
    }
    if (g_lo <= 0) return solver_.t_old();
    for (int i = 0, side = 0; i < 100 && hi - lo > 1e-15 * hi; ++i) {
      const double t = (lo * g_hi - hi * g_lo) / (g_hi - g_lo), g = margin(solver_.at(t));
      if (std::fabs(g) < 1e-16) return t;
      if (g > 0) {
        lo = t, g_lo = g;
        if (side == 1) g_hi /= 2;
        side = 1;
      } else {
        hi = t, g_hi = g;
        if (side == -1) g_lo /= 2;
        side = -1;
      }
    }
    return hi;
  }

  void change_mode(double t) {
    State y = solver_.at(t);
    WheelFriction& friction = solver_.scene.friction;
    const bool released = friction.kind == WHEEL_HELD;
    if (!released) y[3] = 0;
    double spare;
    const double tau = holding(y, &spare);
    friction.kind = !released && spare >= 0 ? WHEEL_HELD : WHEEL_ROLLING;
    friction.sigma = tau > 0 ? -1 : 1;
    solver_.restart(t, y);
  }

  Dop853 solver_;
  double spacing_;
  int points_, done_ = 0;
  double* rows_;
  bool exact_;
};

}  // namespace

extern "C" {

// rows: points x 4; counts: steps, right-hand sides, transitions. 0 where it did not reach the end.
int dop853(const WheelScene* scene, const double* y_0, double tolerance, double stop, int points, double* rows,
           long* counts) {
  State y;
  for (int i = 0; i < size; ++i) y[i] = y_0[i];
  counts[0] = counts[1] = counts[2] = 0;
  return Solution(*scene, y, tolerance, stop / (points - 1), points, rows).run(counts);
}

// As numbalsoda calls a right-hand side.
long wheel_rhs_count = 0;
void wheel_rhs(double, const double* y, double* y_dot, const WheelScene* const* scene) {
  ++wheel_rhs_count;
  derivative(*scene, y, y_dot);
}
}
