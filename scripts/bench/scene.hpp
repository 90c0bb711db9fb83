// What the C++ peers share: the scene from the command line, the grid, the outputs, the clock, the JSON line.
// Frames and names as in wheel_equations.h; the right-hand side is the product's own.
#pragma once

#include <array>
#include <cstdio>
#include <functional>
#include <string_view>
#include <vector>

#include "wheel_equations.h"

struct Scene {
  WheelScene wheel;
  WheelMotion start;
  const WheelFormulation* formulation;
  double tolerance, stop, seconds;
  int points; /* of the grid, both ends included */
  bool rows;
  std::string_view solver;
};

using Row = std::array<double, 4>; /* X_O, theta, phi_dot, psi_dot */

struct Solution {
  std::vector<Row> rows;
  long steps = 0, evaluations = 0, events = 0;
  bool reached = false;
};

using Solver = std::function<Solution(const Scene&)>;

/* name=value pairs: the parameters of modelDescription.xml, and tolerance, stop, points, seconds, rows, solver. */
Scene read_scene(int count, char** arguments);

Row outputs(const Scene& scene, const double* y);

/* Repeats the solution for scene.seconds and prints best, median, counts and, if asked for, the rows. */
void report(const Scene& scene, const Solver& solve);
