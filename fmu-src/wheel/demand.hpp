// What the caller has set. Parameters and tolerance make the setup when initialization ends; inputs, their derivatives
// and `s` may be set again later and are in force from the next step on.
#pragma once

#include <limits>

#include "inputs.hpp"
#include "variables.hpp"

namespace wheel {

// Relative tolerance of the whole solution: over ten seconds of the paper's scenes the relative error of the energy
// stays below it (docs/results/accuracy.md).
inline constexpr double default_tolerance = 1e-8, tightest_tolerance = 1e-13, loosest_tolerance = 1e-4;

// Who integrates the motion.
enum class Kind : int { co_simulation, model_exchange };

struct Demand {
  static constexpr double never = std::numeric_limits<double>::infinity();

  double parameters[first_input];  // in the order of the variables; `s` is the one asked for
  Polynomials inputs = {};         // from the instant at which they take effect
  double start_time = 0, stop_time = never, tolerance = default_tolerance;
  Kind kind;
  bool changed = false;  // something has been set since the last step

  // Of a variable below stored_count.
  double& value(unsigned v) { return v < first_input ? parameters[v] : inputs[v - first_input][0]; }
  double value(unsigned v) const { return v < first_input ? parameters[v] : inputs[v - first_input][0]; }

  explicit Demand(Kind own = Kind::co_simulation) : kind(own) {
    for (unsigned v = 0; v < first_input; ++v) parameters[v] = row_of(v).start;
  }
};

}  // namespace wheel
