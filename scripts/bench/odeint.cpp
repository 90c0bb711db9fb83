// The wheel by Boost.odeint with the product's right-hand side: smooth scenes only (odeint has no events).
// Frames and names as in wheel_equations.h. solver=dopri5 | bulirsch_stoer (dense output) | fehlberg78 (steps to the
// grid).
#include <boost/numeric/odeint.hpp>

#include "scene.hpp"

namespace {

namespace odeint = boost::numeric::odeint;

template <int N>
Solution solve_in(const Scene& scene) {
  using State = std::array<double, N>;
  Solution solution;
  State y{};
  scene.formulation->start(&scene.wheel.wheel, &scene.start, y.data());
  std::vector<double> grid(scene.points);
  for (int i = 0; i < scene.points; ++i) grid[i] = scene.stop * i / (scene.points - 1);
  solution.rows.reserve(grid.size());
  const auto derivative = scene.formulation->derivative;
  auto rhs = [&](const State& y_now, State& y_dot, double) {
    ++solution.evaluations;
    derivative(&scene.wheel, y_now.data(), y_dot.data());
  };
  auto record = [&](const State& y_now, double) { solution.rows.push_back(outputs(scene, y_now.data())); };
  auto run = [&](auto stepper) {
    solution.steps = static_cast<long>(odeint::integrate_times(stepper, rhs, y, grid.begin(), grid.end(), 1e-3, record,
                                                               odeint::max_step_checker(20000)));
  };
  const double tolerance = scene.tolerance;
  if (scene.solver == "fehlberg78")
    run(odeint::make_controlled(tolerance, tolerance, odeint::runge_kutta_fehlberg78<State>()));
  else if (scene.solver == "bulirsch_stoer")
    run(odeint::bulirsch_stoer_dense_out<State>(tolerance, tolerance));
  else
    run(odeint::make_dense_output(tolerance, tolerance, odeint::runge_kutta_dopri5<State>()));
  solution.reached = true;
  return solution;
}

Solution solve(const Scene& scene) {
  try {
    if (scene.formulation == &wheel_multibody) return solve_in<WHEEL_MULTIBODY_STATES>(scene);
    return solve_in<WHEEL_REDUCED_STATES>(scene);
  } catch (const std::exception&) { /* no progress or too many steps: a row of the table that says so */
    return {};
  }
}

}  // namespace

int main(int argc, char** argv) { report(read_scene(argc, argv), solve); }
