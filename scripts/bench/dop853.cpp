// The wheel by DOP853: what a hand-written program reaches. For the reduced formulation the product's right-hand side
// is compiled into this file, so that it is inlined; the multibody one is called. Exact friction as physics asks for
// it: a mode ends where its margin falls through zero on the dense output, and the next one starts there.
extern "C" {
#include "reduced.c"
}

#include "dop853.hpp"
#include "scene.hpp"

namespace {

constexpr long most_steps = 200000, most_events = 1000;

struct Inlined {
  WheelScene scene;
  void operator()(const double* y, double* y_dot) const { derivative(&scene, y, y_dot); }
};

struct Called {
  WheelScene scene;
  void operator()(const double* y, double* y_dot) const { wheel_multibody.derivative(&scene, y, y_dot); }
};

// Moment that would hold omega_z = 0, and what friction has left over it.
struct Grip {
  double tau, margin;
};

Grip grip(const WheelScene& scene, const WheelFormulation& formulation, const double* y) {
  WheelScene held = scene;
  held.friction.kind = WHEEL_HELD;
  WheelDynamics now;
  formulation.dynamics(&held, y, &now);
  return {now.tau, scene.wheel.s * std::fmax(now.lambda[2], 0) - std::fabs(now.tau)};
}

template <int N, class Rhs>
class Wheel {
 public:
  using Solver = Dop853<N, Rhs>;
  using State = typename Solver::State;

  explicit Wheel(const Scene& scene) : scene_(scene), solver_(Rhs{scene.wheel}, initial(scene), scene.tolerance) {
    exact_ = scene.wheel.friction.kind == WHEEL_ROLLING;
    if (exact_) solver_.rhs().scene.friction.sigma = solver_.y()[scene.formulation->spin_index] > 0 ? 1 : -1;
    solver_.restart(0, solver_.y());
    spacing_ = scene.stop / (scene.points - 1);
  }

  Solution solve() {
    solution_.rows.reserve(scene_.points);
    solution_.rows.push_back(outputs(scene_, solver_.y().data()));
    while (static_cast<int>(solution_.rows.size()) < scene_.points) {
      if (!solver_.step() || solver_.steps > most_steps || solution_.events > most_events) return solution_;
      const bool falls = exact_ && margin(solver_.y()) < 0;
      const double t = falls ? fall() : solver_.t();
      record(t);
      if (falls) change_mode(t);
    }
    solution_.steps = solver_.steps;
    solution_.evaluations = solver_.evaluations;
    solution_.reached = true;
    return solution_;
  }

 private:
  static State initial(const Scene& scene) {
    State y{};
    scene.formulation->start(&scene.wheel.wheel, &scene.start, y.data());
    return y;
  }

  void record(double t_end) {
    for (double t; static_cast<int>(solution_.rows.size()) < scene_.points &&
                   (t = spacing_ * static_cast<double>(solution_.rows.size())) <= t_end;)
      solution_.rows.push_back(outputs(scene_, solver_.at(t).data()));
  }

  double margin(const State& y) {
    const WheelFriction& friction = solver_.rhs().scene.friction;
    if (friction.kind == WHEEL_HELD) return grip(solver_.rhs().scene, *scene_.formulation, y.data()).margin;
    return friction.sigma * y[scene_.formulation->spin_index];
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
    WheelFriction& friction = solver_.rhs().scene.friction;
    const bool released = friction.kind == WHEEL_HELD;
    if (!released) scene_.formulation->stop_spin(&scene_.wheel.wheel, y.data());
    const Grip now = grip(solver_.rhs().scene, *scene_.formulation, y.data());
    friction.kind = !released && now.margin >= 0 ? WHEEL_HELD : WHEEL_ROLLING;
    friction.sigma = now.tau > 0 ? -1 : 1;
    ++solution_.events;
    solver_.restart(t, y);
  }

  Scene scene_;
  Solver solver_;
  Solution solution_;
  bool exact_;
  double spacing_;
};

Solution solve(const Scene& scene) {
  if (scene.formulation == &wheel_multibody) return Wheel<WHEEL_MULTIBODY_STATES, Called>(scene).solve();
  return Wheel<WHEEL_REDUCED_STATES, Inlined>(scene).solve();
}

}  // namespace

int main(int argc, char** argv) { report(read_scene(argc, argv), solve); }
