// Parameters and start values checked as a whole: one message per fault (what, which value, what is allowed).
#include "checks.hpp"

#include <cmath>

#include "events.hpp"

namespace wheel {
namespace {

bool strictly_positive(unsigned v) {
  using namespace stored;
  return v == m || v == r_0 || v == J_x || v == J_y || v == J_z || v == omega_s;
}

bool check_value(const Reporter& reporter, unsigned v, double value) {
  const Row& row = row_of(v);
  const auto fault = [&](auto... format) {
    reporter.log(Topic::error, format...);
    return false;
  };
  if (!std::isfinite(value)) return fault("%s = %s: a finite number is needed.", row.name, Digits(value, 9));
  if (v == stored::theta_start && !(std::sin(value) > flat_angle && value > 0 && value < row.max))
    return fault("theta_start = %s rad: the wheel must stand above the ground, 0 < theta < pi.", Digits(value, 9));
  if ((v == stored::psi_start || v == stored::phi_start) && std::fabs(value) > largest_angle)
    return fault("%s = %s rad: beyond %s rad an angle has too few digits.", row.name, Digits(value, 9),
                 Digits(largest_angle, 6));
  if (strictly_positive(v) && value <= row.min)
    return fault("%s = %s: it must be greater than %s.", row.name, Digits(value, 9), Digits(row.min, 6));
  if (value < row.min) return fault("%s = %s: it must be at least %s.", row.name, Digits(value, 9), Digits(row.min, 6));
  if (v == stored::slope && value >= row.max)
    return fault("slope = %s rad: it must be less than pi/2.", Digits(value, 9));
  if (value > row.max) return fault("%s = %s: it must be at most %s.", row.name, Digits(value, 9), Digits(row.max, 6));
  return true;
}

// Only the reduced equations are offered to another solver. The number may be any: a restored state is judged here too.
bool check_kind(const Reporter& reporter, const Demand& demand) {
  if (demand.kind == Kind::co_simulation || demand.parameters[stored::formulation] != int{multibody_formulation})
    return true;
  reporter.log(Topic::error, "formulation = 3 (multibody): model exchange needs 1 (automatic) or 2 (reduced).");
  return false;
}

// No mass distribution has one principal moment above the sum of the others; the limit is the flat disc.
bool check_inertia(const Reporter& reporter, const double* v) {
  constexpr double rounding = 1e-12;
  const double J_x = v[stored::J_x], J_y = v[stored::J_y], J_z = v[stored::J_z], sum = J_x + J_y + J_z;
  const double largest = std::fmax(J_x, std::fmax(J_y, J_z));
  if (largest <= (sum - largest) * (1 + rounding) || !std::isfinite(sum)) return true;
  reporter.log(Topic::error, "J_x, J_y, J_z = %s, %s, %s kg m2: none may exceed the sum of the other two.",
               Digits(J_x, 9), Digits(J_y, 9), Digits(J_z, 9));
  return false;
}

}  // namespace

bool check_values(const Demand& demand, const Reporter& reporter) {
  bool sound = true;
  for (unsigned v = 0; v < stored_count; ++v)
    sound &= check_value(reporter, v, v < first_input ? demand.parameters[v] : demand.inputs[v - first_input][0]);
  sound &= check_inertia(reporter, demand.parameters);
  sound &= check_kind(reporter, demand);
  return sound;
}

bool is_inside(Reading& now) {
  double sum = wheel_energy(&now.scene().wheel, &now.kinematics()) + now.dynamics().tau;
  for (const double force : now.dynamics().lambda) sum += force;
  return angle_from_flat(now.pose().theta) > 0 && std::isfinite(sum);
}

bool check_start(const Demand& demand, Reading& start, const Reporter& reporter) {
  if (is_inside(start)) return true;
  const double* v = demand.parameters;
  reporter.log(Topic::error,
               "The initial energy or reaction force overflows: m = %s kg, J_z = %s kg m2, r_0 = %s m, g = %s m/s2, "
               "omega_z = %s rad/s.",
               Digits(v[stored::m], 3), Digits(v[stored::J_z], 3), Digits(v[stored::r_0], 3), Digits(v[stored::g], 3),
               Digits(start.kinematics().omega_z, 3));
  return false;
}

}  // namespace wheel
