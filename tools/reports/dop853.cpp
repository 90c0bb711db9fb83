// The wheel by DOP853 on a grid, called from Python (reports/native.py): the fastest Runge-Kutta solution of the wheel
// that the speed report knows. Dormand and Prince, order 8 with dense output of order 7, and the wheel's right-hand
// side inlined. Coefficients: fmu-src/solver/dormand_prince.hpp. Step control, error norm and dense output are those of
// SciPy's DOP853, with one tolerance for relative and absolute error. Exact friction as physics asks for it: a mode
// ends where its margin falls through zero on the dense output, and the next one starts there. Frames and names as in
// wheel_equations.h.
#include <Eigen/Core>
#include <array>
#include <cmath>
#include <utility>

extern "C" {
#include "reduced.c"
}
#include "dormand_prince.hpp"

namespace {

namespace pair = solver::dormand_prince;
using State = Eigen::Array<double, WHEEL_REDUCED_STATES, 1>;

constexpr long most_steps = 200000, most_events = 1000;

// One solution on a grid of equal spacing, with exact or regularized friction or none.
class Solution {
 public:
  Solution(const WheelScene& scene, const State& y, double tolerance, double spacing, int points, double* rows)
      : scene_(scene), tolerance_(tolerance), spacing_(spacing), points_(points), rows_(rows) {
    exact_ = scene.friction.kind == WHEEL_ROLLING;
    if (exact_) scene_.friction.sigma = y[3] > 0 ? 1 : -1;
    restart(0, y);
    write(y);
  }

  // counts: steps, right-hand sides, transitions. False where it does not reach the end.
  bool run(long* counts) {
    while (done_ < points_) {
      if (!step() || steps_ > most_steps || counts[2] > most_events) return false;
      const bool falls = exact_ && margin(y_) < 0;
      const double t = falls ? fall() : t_;
      for (double next; done_ < points_ && (next = spacing_ * done_) <= t;) write(at(next));
      if (falls) change_mode(t), ++counts[2];
    }
    counts[0] = steps_, counts[1] = evaluations_;
    return true;
  }

 private:
  // From y at t, with the step size reached so far.
  void restart(double t, const State& y) {
    t_ = t_old_ = t;
    y_ = y;
    evaluate(y_, f_[0]);
    if (h_ == 0) h_ = first_step();
  }

  // A guess from the size of y' alone; the first steps correct it.
  double first_step() const {
    const double rate = (f_[0].abs() / (1 + y_.abs())).maxCoeff();
    return 0.5 * std::pow(tolerance_, 1.0 / 8) / std::fmax(rate, 1e-3);
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
    ++steps_;
    y_old_ = y_, y_ = y_new_;
    t_old_ = t_, t_ += h_done_;
    interpolates_ = false;
    return true;
  }

  // y(t) inside the last step; the three further stages are evaluated once per step, and only if asked for.
  State at(double t) {
    if (!interpolates_) prepare_interpolant();
    const double x = (t - t_old_) / h_done_;
    State y = State::Zero();
    for (int i = 6; i >= 0; --i) y = (y + F_[i]) * (i % 2 ? 1 - x : x);
    return y_old_ + y;
  }

  void evaluate(const State& y, State& y_dot) {
    derivative(&scene_, y.data(), y_dot.data());
    ++evaluations_;
  }

  // The sum of a row's terms, unrolled at compile time.
  template <const auto& row>
  State combine() const {
    return [&]<std::size_t... j>(std::index_sequence<j...>) -> State {
      return ((row[j].weight * f_[row[j].stage]) + ...);
    }(std::make_index_sequence<std::size(row)>());
  }

  template <int stage, const auto& row>
  void evaluate_stage(const State& from, double h) {
    evaluate(from + h * combine<row>(), f_[stage]);
  }

  void try_step() {
    evaluate_stage<1, pair::a_1>(y_, h_), evaluate_stage<2, pair::a_2>(y_, h_);
    evaluate_stage<3, pair::a_3>(y_, h_), evaluate_stage<4, pair::a_4>(y_, h_);
    evaluate_stage<5, pair::a_5>(y_, h_), evaluate_stage<6, pair::a_6>(y_, h_);
    evaluate_stage<7, pair::a_7>(y_, h_), evaluate_stage<8, pair::a_8>(y_, h_);
    evaluate_stage<9, pair::a_9>(y_, h_), evaluate_stage<10, pair::a_10>(y_, h_);
    evaluate_stage<11, pair::a_11>(y_, h_);
    y_new_ = y_ + h_ * combine<pair::b>();
    evaluate(y_new_, f_[12]);
  }

  double step_error() const {
    const State scale = tolerance_ * (1 + y_.abs().max(y_new_.abs()));
    const double sum_5 = (combine<pair::e_5>() / scale).square().sum();
    const double sum_3 = (combine<pair::e_3>() / scale).square().sum();
    const double both = sum_5 + 0.01 * sum_3;
    if (both == 0) return 1e-9;
    const double error = h_ * sum_5 / std::sqrt(both * y_.size());
    return std::isfinite(error) ? std::fmax(error, 1e-9) : 1e9;
  }

  void prepare_interpolant() {
    evaluate_stage<13, pair::a_13>(y_old_, h_done_), evaluate_stage<14, pair::a_14>(y_old_, h_done_);
    evaluate_stage<15, pair::a_15>(y_old_, h_done_);
    const State delta = y_ - y_old_;
    F_[0] = delta;
    F_[1] = h_done_ * f_[0] - delta;
    F_[2] = 2 * delta - h_done_ * (f_[12] + f_[0]);
    F_[3] = h_done_ * combine<pair::d_3>(), F_[4] = h_done_ * combine<pair::d_4>();
    F_[5] = h_done_ * combine<pair::d_5>(), F_[6] = h_done_ * combine<pair::d_6>();
    interpolates_ = true;
  }

  // X_O, theta, phi_dot, psi_dot
  void write(const State& y) {
    WheelKinematics k;
    pose(&scene_.wheel, y.data(), &k);
    Eigen::Map<Eigen::Array4d>(rows_ + 4 * done_++) = Eigen::Array4d(k.X_O, k.theta, k.phi_dot, k.psi_dot);
  }

  // The moment that would hold omega_z = 0, and how far its size lies below s N.
  struct Grip {
    double tau, spare;
  };
  Grip grip(const State& y) const {
    WheelScene held = scene_;
    held.friction.kind = WHEEL_HELD;
    WheelDynamics now;
    dynamics(&held, y.data(), &now);
    return {now.tau, held.wheel.s * std::fmax(now.lambda[2], 0) - std::fabs(now.tau)};
  }

  // The mode ends where it falls below zero.
  double margin(const State& y) const {
    return scene_.friction.kind == WHEEL_HELD ? grip(y).spare : scene_.friction.sigma * y[3];
  }

  // The margin's fall through zero in the last step (Illinois). Its zero at the start, after a release, is left out.
  double fall() {
    double t[] = {t_, t_}, g[] = {margin(y_), -1};  // below zero, above zero
    for (int i = 0; i < 40 && g[1] <= 0; ++i) {
      t[1] = t_old_ + 0.5 * (t[1] - t_old_);
      g[1] = margin(at(t[1]));
    }
    if (g[1] <= 0) return t_old_;
    for (int i = 0, last = -1; i < 100 && t[0] - t[1] > 1e-15 * t[0]; ++i) {
      const double next = (t[1] * g[0] - t[0] * g[1]) / (g[0] - g[1]), value = margin(at(next));
      if (std::fabs(value) < 1e-16) return next;
      const int side = value > 0;
      t[side] = next, g[side] = value;
      if (side == last) g[1 - side] /= 2;
      last = side;
    }
    return t[0];
  }

  void change_mode(double t) {
    State y = at(t);
    WheelFriction& friction = scene_.friction;
    const bool released = friction.kind == WHEEL_HELD;
    if (!released) y[3] = 0;
    const Grip now = grip(y);
    friction.kind = !released && now.spare >= 0 ? WHEEL_HELD : WHEEL_ROLLING;
    friction.sigma = now.tau > 0 ? -1 : 1;
    restart(t, y);
  }

  WheelScene scene_;
  double tolerance_, spacing_;
  int points_, done_ = 0;
  double* rows_;
  bool exact_, interpolates_ = false;
  long steps_ = 0, evaluations_ = 0;
  double t_ = 0, t_old_ = 0, h_ = 0, h_done_ = 0;
  State y_, y_old_, y_new_;
  std::array<State, 16> f_;
  std::array<State, 7> F_;
};

}  // namespace

extern "C" {

// rows: points x 4; counts: steps, right-hand sides, transitions. 0 where it did not reach the end.
int dop853(const WheelScene* scene, const double* y_0, double tolerance, double stop, int points, double* rows,
           long* counts) {
  counts[0] = counts[1] = counts[2] = 0;
  return Solution(*scene, Eigen::Map<const State>(y_0), tolerance, stop / (points - 1), points, rows).run(counts);
}
}
