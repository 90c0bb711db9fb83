// Parameters and start values checked as a whole: one message per fault (what, which value, what is allowed).
#include <cmath>

#include "events.hpp"
#include "reading.hpp"

namespace wheel {
namespace {

bool is_positive(unsigned v) {
  using namespace variable;
  return v == m || v == r_0 || v == J_x || v == J_y || v == J_z || v == omega_s;
}

bool check_value(const Reporter& reporter, unsigned v, double value) {
  using namespace variable;
  const Row& row = row_of(v);
  const char* fault = nullptr;
  double limit = row.min;
  if (!std::isfinite(value)) {
    fault = "%s = %s: a finite number is needed.";
  } else if (v == theta_start && !(std::sin(value) > flat_angle && value > 0 && value < row.max)) {
    fault = "%s = %s rad: the wheel must stand above the ground, 0 < theta < %s.";
    limit = row.max;
  } else if ((v == psi_start || v == phi_start) && std::fabs(value) > largest_angle) {
    fault = "%s = %s rad: beyond %s rad an angle has too few digits.";
    limit = largest_angle;
  } else if (is_positive(v) ? value <= row.min : value < row.min) {
    fault = is_positive(v) ? "%s = %s: it must be greater than %s." : "%s = %s: it must be at least %s.";
  } else if (v == slope ? value >= row.max : value > row.max) {
    fault = v == slope ? "%s = %s: it must be less than %s." : "%s = %s: it must be at most %s.";
    limit = row.max;
  }
  if (fault) reporter.log(Topic::error, fault, row.name, Digits(value, 9), Digits(limit, 6));
  return !fault;
}

// Only the reduced equations are offered to another solver. The number may be any: a restored state is judged here too.
bool check_kind(const Reporter& reporter, const Demand& demand) {
  if (demand.kind == Kind::co_simulation || demand.parameters[variable::formulation] != int{multibody_formulation})
    return true;
  reporter.log(Topic::error, "formulation = 3 (multibody): model exchange needs 1 (automatic) or 2 (reduced).");
  return false;
}

// No mass distribution has one principal moment above the sum of the others; the limit is the flat disc.
bool check_inertia(const Reporter& reporter, const double* v) {
  constexpr double rounding = 1e-12;
  const double J_x = v[variable::J_x], J_y = v[variable::J_y], J_z = v[variable::J_z], sum = J_x + J_y + J_z;
  const double largest = std::fmax(J_x, std::fmax(J_y, J_z));
  if (largest <= (sum - largest) * (1 + rounding) || !std::isfinite(sum)) return true;
  reporter.log(Topic::error, "J_x, J_y, J_z = %s, %s, %s kg m2: none may exceed the sum of the other two.",
               Digits(J_x, 9), Digits(J_y, 9), Digits(J_z, 9));
  return false;
}

}  // namespace

bool check_values(const Demand& demand, const Reporter& reporter) {
  bool sound = true;
  for (unsigned v = 0; v < stored_count; ++v) sound &= check_value(reporter, v, demand.value(v));
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
  const auto set = [&](variable::Reference v) { return Digits(demand.parameters[v], 3); };
  reporter.log(Topic::error,
               "The initial energy or reaction force overflows: m = %s kg, J_z = %s kg m2, r_0 = %s m, g = %s m/s2, "
               "omega_z = %s rad/s.",
               set(variable::m), set(variable::J_z), set(variable::r_0), set(variable::g),
               Digits(start.kinematics().omega_z, 3));
  return false;
}

}  // namespace wheel
