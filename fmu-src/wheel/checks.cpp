// Parameters and start values checked as a whole: one sentence per fault (what, which value, what is allowed).
#include <cmath>
#include <cstdio>

#include "scene.hpp"
#include "simulation.hpp"

namespace wheel {
namespace {

bool strictly_positive(unsigned v) {
  return v == m || v == r_0 || v == J_x || v == J_y || v == J_z || v == omega_s || v == theta_start;
}

// Empty where the value is allowed.
void fault_of(unsigned v, double value, char* sentence, std::size_t size) {
  const Row& row = row_of(v);
  sentence[0] = 0;
  if (!std::isfinite(value)) {
    std::snprintf(sentence, size, "%s = %g: a finite number is needed.", row.name, value);
  } else if (v == theta_start && !(std::sin(value) > flat_sine && value > 0 && value < row.max)) {
    std::snprintf(sentence, size, "theta_start = %.9g rad: the wheel must stand above the ground, 0 < theta < pi.",
                  value);
  } else if (strictly_positive(v) ? value <= row.min : value < row.min) {
    std::snprintf(sentence, size, "%s = %.9g: it must be %s %g.", row.name, value,
                  strictly_positive(v) ? "greater than" : "at least", row.min);
  } else if (value > row.max) {
    std::snprintf(sentence, size, "%s = %.9g: it must be at most %g.", row.name, value, row.max);
  }
}

// No mass distribution has one principal moment above the sum of the others; the limit is the flat disc.
void inertia_fault(const double* v, char* sentence, std::size_t size) {
  sentence[0] = 0;
  constexpr double rounding = 1e-12;
  const double sum = v[J_x] + v[J_y] + v[J_z];
  const double largest = std::fmax(v[J_x], std::fmax(v[J_y], v[J_z]));
  if (largest <= (sum - largest) * (1 + rounding) || !std::isfinite(sum)) return;
  std::snprintf(sentence, size, "J_x, J_y, J_z = %.9g, %.9g, %.9g kg m2: none may exceed the sum of the other two.",
                v[J_x], v[J_y], v[J_z]);
}

void formulation_fault(const double* v, char* sentence, std::size_t size) {
  sentence[0] = 0;
  if (choice_of(v[formulation]) == reduced_formulation && v[J_x] != v[J_y])
    std::snprintf(sentence, size,
                  "formulation = reduced needs J_x = J_y, not %.17g and %.17g; automatic or multibody take any.",
                  v[J_x], v[J_y]);
}

}  // namespace

// Values that are sound one by one can still have products that are no finite numbers.
bool Simulation::check_start(bool report) {
  const WheelDynamics& forces = now_.dynamics();
  const double numbers[] = {wheel_energy(&scene_.wheel, &now_.kinematics()), forces.lambda[0], forces.lambda[1],
                            forces.lambda[2], forces.tau};
  for (const double number : numbers)
    if (!std::isfinite(number)) {
      if (report)
        tell(Topic::error,
             "The start has energy and forces beyond the range of numbers: m = %.3g kg, J_z = %.3g kg m2, r_0 = %.3g "
             "m, g = %.3g m/s2, omega_z = %.3g rad/s.",
             stored_[m], stored_[J_z], stored_[r_0], stored_[g], now_.kinematics().omega_z);
      return false;
    }
  return true;
}

bool Simulation::check_parameters(bool report) const {
  bool sound = true;
  char sentence[256];
  const auto conclude = [&] {
    if (!sentence[0]) return;
    sound = false;
    if (report) tell(Topic::error, "%s", sentence);
  };
  for (unsigned v = 0; v < stored_count; ++v) {
    fault_of(v, stored_[v], sentence, sizeof sentence);
    conclude();
  }
  inertia_fault(stored_, sentence, sizeof sentence);
  conclude();
  formulation_fault(stored_, sentence, sizeof sentence);
  conclude();
  return sound;
}

}  // namespace wheel
