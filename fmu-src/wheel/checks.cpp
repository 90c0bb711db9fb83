// Parameters and start values checked as a whole: one sentence per fault (what, which value, what is allowed).
#include "checks.hpp"

#include <cmath>
#include <cstdio>

#include "digits.hpp"
#include "simulation.hpp"

namespace wheel {
namespace {

using support::Digits;

bool strictly_positive(unsigned v) {
  return v == m || v == r_0 || v == J_x || v == J_y || v == J_z || v == omega_s || v == theta_start;
}

// Empty where the value is allowed.
void fault_of(unsigned v, double value, char* sentence, std::size_t size) {
  const Row& row = row_of(v);
  sentence[0] = 0;
  if (!std::isfinite(value)) {
    std::snprintf(sentence, size, "%s = %s: a finite number is needed.", row.name, Digits(value, 9).text);
  } else if (v == theta_start && !(std::sin(value) > flat_angle && value > 0 && value < row.max)) {
    std::snprintf(sentence, size, "theta_start = %s rad: the wheel must stand above the ground, 0 < theta < pi.",
                  Digits(value, 9).text);
  } else if ((v == psi_start || v == phi_start) && std::fabs(value) > largest_angle) {
    std::snprintf(sentence, size, "%s = %s rad: beyond 1e12 rad an angle has too few digits.", row.name,
                  Digits(value, 9).text);
  } else if (strictly_positive(v) ? value <= row.min : value < row.min) {
    std::snprintf(sentence, size, "%s = %s: it must be %s %s.", row.name, Digits(value, 9).text,
                  strictly_positive(v) ? "greater than" : "at least", Digits(row.min, 6).text);
  } else if (v == slope && value >= row.max) {
    std::snprintf(sentence, size, "slope = %s rad: it must be less than pi/2.", Digits(value, 9).text);
  } else if (value > row.max) {
    std::snprintf(sentence, size, "%s = %s: it must be at most %s.", row.name, Digits(value, 9).text,
                  Digits(row.max, 6).text);
  }
}

// Only the reduced equations are offered to another solver.
void kind_fault(const Demand& demand, char* sentence, std::size_t size) {
  sentence[0] = 0;
  if (demand.kind == Kind::model_exchange && choice_of(demand.parameters[formulation]) == multibody_formulation)
    std::snprintf(sentence, size, "formulation = 3 (multibody): model exchange needs 1 (automatic) or 2 (reduced).");
}

// No mass distribution has one principal moment above the sum of the others; the limit is the flat disc.
void inertia_fault(const double* v, char* sentence, std::size_t size) {
  sentence[0] = 0;
  constexpr double rounding = 1e-12;
  const double sum = v[J_x] + v[J_y] + v[J_z];
  const double largest = std::fmax(v[J_x], std::fmax(v[J_y], v[J_z]));
  if (largest <= (sum - largest) * (1 + rounding) || !std::isfinite(sum)) return;
  std::snprintf(sentence, size, "J_x, J_y, J_z = %s, %s, %s kg m2: none may exceed the sum of the other two.",
                Digits(v[J_x], 9).text, Digits(v[J_y], 9).text, Digits(v[J_z], 9).text);
}

}  // namespace

bool check_values(const Demand& demand, void* owner, void (*tell)(void* owner, const char* sentence)) {
  bool sound = true;
  char sentence[256];
  const auto conclude = [&] {
    if (!sentence[0]) return;
    sound = false;
    if (tell) tell(owner, sentence);
  };
  for (unsigned v = 0; v < stored_count; ++v) {
    fault_of(v, v < first_input ? demand.parameters[v] : demand.inputs[v - first_input][0], sentence, sizeof sentence);
    conclude();
  }
  inertia_fault(demand.parameters, sentence, sizeof sentence);
  conclude();
  kind_fault(demand, sentence, sizeof sentence);
  conclude();
  return sound;
}

bool Simulation::check_parameters(bool report) {
  const auto tell_fault = [](void* owner, const char* sentence) {
    static_cast<Simulation*>(owner)->tell(Topic::error, "%s", sentence);
  };
  return check_values(demand_, this, report ? +tell_fault : nullptr);
}

bool is_inside(Reading& now) {
  double sum = wheel_energy(&now.scene().wheel, &now.kinematics()) + now.dynamics().tau;
  for (const double force : now.dynamics().lambda) sum += force;
  return angle_from_flat(now.pose().theta) > 0 && std::isfinite(sum);
}

// Values that are sound one by one can still have products that are not finite.
bool Simulation::check_start(bool report) {
  if (is_inside(reading())) return true;
  const double* v = demand_.parameters;
  if (report)
    tell(Topic::error,
         "The initial energy or reaction force overflows: m = %s kg, J_z = %s kg m2, r_0 = %s m, g = %s m/s2, "
         "omega_z = %s rad/s.",
         Digits(v[m], 3).text, Digits(v[J_z], 3).text, Digits(v[r_0], 3).text, Digits(v[g], 3).text,
         Digits(reading().kinematics().omega_z, 3).text);
  return false;
}

}  // namespace wheel
