// Command line, clock and JSON of the C++ peers.
#include "scene.hpp"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <cstring>

namespace {

double* place_of(Scene& s, std::string_view name) {
  WheelParameters& w = s.wheel.wheel;
  WheelMotion& q = s.start;
  const std::pair<std::string_view, double*> places[] = {
      {"m", &w.m},
      {"r_0", &w.r_0},
      {"r", &w.r},
      {"J_x", &w.J_x},
      {"J_y", &w.J_y},
      {"J_z", &w.J_z},
      {"g", &w.g},
      {"s", &w.s},
      {"psi_start", &q.psi},
      {"theta_start", &q.theta},
      {"phi_start", &q.phi},
      {"psi_dot_start", &q.psi_dot},
      {"theta_dot_start", &q.theta_dot},
      {"phi_dot_start", &q.phi_dot},
      {"X_O_start", &q.X_O},
      {"Y_O_start", &q.Y_O},
      {"omega_s", &s.wheel.friction.omega_s},
      {"tolerance", &s.tolerance},
      {"stop", &s.stop},
      {"seconds", &s.seconds},
  };
  for (const auto& [key, place] : places)
    if (key == name) return place;
  return nullptr;
}

}  // namespace

Scene read_scene(int count, char** arguments) {
  Scene scene = {};
  bool multibody = false, regularized = false;
  scene.points = 101;
  for (int i = 1; i < count; ++i) {
    const std::string_view argument = arguments[i];
    const std::size_t at = argument.find('=');
    const std::string_view name = argument.substr(0, at),
                           value = argument.substr(std::min(at, argument.size() - 1) + 1);
    const double number = std::atof(value.data());
    if (double* place = place_of(scene, name)) *place = number;
    if (name == "solver") scene.solver = value;
    if (name == "points") scene.points = static_cast<int>(number);
    if (name == "rows") scene.rows = number != 0;
    if (name == "formulation") multibody = number == 3;
    if (name == "friction_law") regularized = number == 2;
  }
  scene.formulation = multibody ? &wheel_multibody : &wheel_reduced;
  if (scene.wheel.wheel.s > 0) scene.wheel.friction.kind = regularized ? WHEEL_REGULARIZED : WHEEL_ROLLING;
  return scene;
}

Row outputs(const Scene& scene, const double* y) {
  WheelKinematics k;
  scene.formulation->kinematics(&scene.wheel.wheel, y, &k);
  return {k.X_O, k.theta, k.phi_dot, k.psi_dot};
}

void report(const Scene& scene, const Solver& solve) {
  using Clock = std::chrono::steady_clock;
  const auto begin = Clock::now();
  const auto seconds = [](Clock::duration d) { return std::chrono::duration<double>(d).count(); };
  std::vector<double> times;
  Solution solution;
  do {
    const auto start = Clock::now();
    solution = solve(scene);
    times.push_back(seconds(Clock::now() - start));
  } while (seconds(Clock::now() - begin) < scene.seconds || (times.size() < 3 && times[0] < 0.1));
  std::sort(times.begin(), times.end());
  std::printf("{\"status\": %d, \"solve_best\": %.9g, \"solve_median\": %.9g, \"repetitions\": %zu, ",
              solution.reached ? 0 : 3, times[0], times[times.size() / 2], times.size());
  std::printf("\"steps\": %ld, \"evaluations\": %ld, \"events\": %ld", solution.steps, solution.evaluations,
              solution.events);
  if (scene.rows) {
    std::printf(", \"rows\": [");
    for (std::size_t i = 0; i < solution.rows.size(); ++i) {
      const Row& r = solution.rows[i];
      std::printf("%s[%.17g, %.17g, %.17g, %.17g, %.17g]", i ? ", " : "",
                  scene.stop * static_cast<double>(i) / (scene.points - 1), r[0], r[1], r[2], r[3]);
    }
    std::printf("]");
  }
  std::printf("}\n");
}
