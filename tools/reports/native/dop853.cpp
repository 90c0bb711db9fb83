// The wheel by DOP853 on a grid, called from Python (reports/native.py). Exact friction as physics asks for it: a mode
// ends where its margin falls through zero on the dense output, and the next one starts there. Frames and names as in
// wheel_equations.h.
#include "dop853.hpp"

namespace {

constexpr long most_steps = 200000, most_events = 1000;

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

  // The margin's fall through zero in the last step (Illinois). Its zero at the start, after a release, is left out.
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
  const State y = Eigen::Map<const State>(y_0);
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
