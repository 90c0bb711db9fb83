// What modelDescription.xml cannot say: how each calculated variable is read, its rate of change, and limits of stored
// ones that are strict, or that the digits of a number set. A variable of the description without a reader here does
// not compile, nor does a reader without its variable.
#include "variables.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "wheel.hpp"

namespace wheel {
namespace {

constexpr double unlimited = std::numeric_limits<double>::infinity();
// Largest input, N or N m: far above any real load. Products of larger loads with the parameters would overflow.
constexpr double strongest = 1e300;

// (reading) => J, of the whole X_O and Y_O
double energy(Reading& reading) {
  WheelKinematics whole = reading.kinematics();
  whole.X_O = reading.at.setup->X_O.whole(whole.X_O);
  whole.Y_O = reading.at.setup->Y_O.whole(whole.Y_O);
  return wheel_energy(&reading.at.scene.wheel, &whole);
}

// (vector in fixed axes, axis) => its part along e1 (0) or across it (1)
double horizontal(Reading& reading, const double (&vector)[3], int axis) {
  double parts[2];
  wheel_horizontal_force(&reading.kinematics(), vector, parts);
  return parts[axis];
}

// (axis) => m/s, of O
double velocity(Reading& reading, int axis) {
  return horizontal(reading, {reading.kinematics().X_O_dot, reading.kinematics().Y_O_dot, 0}, axis);
}

// (axis) => N m, the wheel carrier's on the wheel: about e1 (0) or e2 (1)
double guide_moment(Reading& reading, int axis) {
  double moment[2] = {};
  if (reading.at.scene.guided)
    wheel_guide_moment(&reading.at.scene, &reading.kinematics(), &reading.dynamics(), moment);
  return moment[axis];
}

// (axis) => m/s, of the wheel's material point at the contact: along e1 (0) or across it (1)
double slip(const Reading& reading, int axis) {
  if (reading.at.scene.contact == WHEEL_GRIPS) return 0;
  const double chi = reading.at.y[WHEEL_CHI];
  return reading.at.y[WHEEL_SLIP] * (axis == 0 ? std::cos(chi) : std::sin(chi));
}

double brake_moment(Reading& reading) {
  const WheelAxleMoment axle = acting_of(reading).axle;
  return wheel_brake_moment(&axle);
}

int friction_mode(Reading& reading) {
  const WheelFriction& friction = reading.at.scene.friction;
  if (friction.kind == WHEEL_HELD) return 0;
  const double side = friction.kind == WHEEL_ROLLING ? friction.sigma : reading.kinematics().omega_z;
  return (side > 0) - (side < 0);
}

struct Access {
  variable::Place variable;
  double (*read)(Reading&);
  double (*read_rate)(Reading&) = nullptr;
  double (*by_force)(const Acting&, const Acting&) = nullptr;
};

#define AT(expression) [](Reading& reading) -> double { return expression; }

constexpr Access readers[] = {
    {variable::X_O, AT(reading.at.setup->X_O.whole(reading.kinematics().X_O)), AT(reading.kinematics().X_O_dot)},
    {variable::Y_O, AT(reading.at.setup->Y_O.whole(reading.kinematics().Y_O)), AT(reading.kinematics().Y_O_dot)},
    {variable::Z_O, AT(reading.kinematics().Z_O), AT(reading.kinematics().Z_O_dot)},
    {variable::psi, AT(reading.at.setup->psi.whole(reading.kinematics().psi)), AT(reading.kinematics().psi_dot)},
    {variable::theta, AT(reading.kinematics().theta), AT(reading.kinematics().theta_dot)},
    {variable::phi, AT(reading.at.setup->phi.whole(reading.kinematics().phi)), AT(reading.kinematics().phi_dot)},
    {variable::X_O_dot, AT(reading.kinematics().X_O_dot), AT(reading.dynamics().X_O_ddot)},
    {variable::Y_O_dot, AT(reading.kinematics().Y_O_dot), AT(reading.dynamics().Y_O_ddot)},
    {variable::Z_O_dot, AT(reading.kinematics().Z_O_dot), AT(reading.dynamics().Z_O_ddot)},
    {variable::psi_dot, AT(reading.kinematics().psi_dot), AT(reading.dynamics().psi_ddot)},
    {variable::theta_dot, AT(reading.kinematics().theta_dot), AT(reading.dynamics().theta_ddot)},
    {variable::phi_dot, AT(reading.kinematics().phi_dot), AT(reading.dynamics().phi_ddot)},
    {variable::omega_z, AT(reading.kinematics().omega_z), AT(reading.dynamics().omega_z_dot)},
    {variable::lambda_1, AT(reading.dynamics().lambda[0])},
    {variable::lambda_2, AT(reading.dynamics().lambda[1])},
    {variable::lambda_3, AT(reading.dynamics().lambda[2])},
    {variable::X_C, AT(reading.at.setup->X_O.whole(reading.contact().X_C)), AT(reading.contact().X_C_dot)},
    {variable::Y_C, AT(reading.at.setup->Y_O.whole(reading.contact().Y_C)), AT(reading.contact().Y_C_dot)},
    {variable::lambda_x, AT(horizontal(reading, reading.dynamics().lambda, 0))},
    {variable::lambda_y, AT(horizontal(reading, reading.dynamics().lambda, 1))},
    {variable::tau, AT(reading.dynamics().tau)},
    {variable::tau_brake, AT(brake_moment(reading)), nullptr,
     [](const Acting& acting, const Acting& rate) { return wheel_brake_moment_rate(&acting.axle, &rate.axle); }},
    {variable::slip_x, AT(slip(reading, 0))},
    {variable::slip_y, AT(slip(reading, 1))},
    {variable::M_guide_1, AT(guide_moment(reading, 0))},
    {variable::M_guide_2, AT(guide_moment(reading, 1))},
    {variable::v_x, AT(velocity(reading, 0))},
    {variable::v_y, AT(velocity(reading, 1))},
    {variable::theta_ddot, AT(reading.dynamics().theta_ddot)},
    {variable::psi_ddot, AT(reading.dynamics().psi_ddot)},
    {variable::phi_ddot, AT(reading.dynamics().phi_ddot)},
    {variable::omega_z_dot, AT(reading.dynamics().omega_z_dot)},
    {variable::E, AT(energy(reading))},
    {variable::mu_required, AT(wheel_required_friction(reading.dynamics().lambda)), nullptr,
     [](const Acting& acting, const Acting& rate) { return wheel_required_friction_rate(acting.lambda, rate.lambda); }},
    {variable::contact_mode, AT(reading.at.scene.contact)},
    {variable::friction_mode, AT(friction_mode(reading))},
    {variable::n_steps, AT(double(reading.at.counters.steps))},
    {variable::n_rhs, AT(double(reading.at.counters.rhs))},
    {variable::n_jac, AT(double(reading.at.counters.jacobians))},
    {variable::n_roots, AT(double(reading.at.counters.roots))},
    {variable::n_events, AT(double(reading.at.transitions))},
    {variable::n_restarts, AT(double(reading.at.counters.restarts))},
};

#undef AT

constexpr Row stored_row(const char* name, Type type, Role role, double start, double min, double max) {
  const double most = role == Role::input ? strongest : unlimited;
  return {name, type, role, start, std::max(min, -most), std::min(max, most), nullptr, nullptr, nullptr};
}

template <unsigned variable>
constexpr Row computed_row(const char* name, Type type, Role role) {
  constexpr auto reads_it = [](const Access& reader) { return reader.variable == variable; };
  static_assert(std::count_if(std::begin(readers), std::end(readers), reads_it) == 1, "one reader for each");
  const Access& r = *std::find_if(std::begin(readers), std::end(readers), reads_it);
  return {name, type, role, 0, -unlimited, unlimited, r.read, r.read_rate, r.by_force};
}

constexpr Row rows[] = {
#define STORED(name, reference, type, role, start, min, max) stored_row(#name, Type::type, Role::role, start, min, max),
#define COMPUTED(name, reference, type, role) computed_row<variable::name>(#name, Type::type, Role::role),
#include "variables.inc"
};

static_assert(std::size(rows) == variable_count && std::size(readers) == variable_count - stored_count);

constexpr bool is_in_its_place(const Row& row) {
  const auto variable = static_cast<unsigned>(&row - rows);
  return (row.role == Role::input) == (variable >= first_input && variable < stored_count);
}
static_assert(std::all_of(std::begin(rows), std::end(rows), is_in_its_place), "the inputs end the stored variables");
static_assert(stored_count - first_input == inputs_count);

constexpr unsigned references[] = {
#define STORED(name, reference, ...) reference,
#define COMPUTED(name, reference, ...) reference,
#include "variables.inc"
};

// The places by value reference; variable_count where no variable has it.
constexpr auto places = [] {
  std::array<unsigned, *std::max_element(std::begin(references), std::end(references)) + 1> place = {};
  place.fill(variable_count);
  for (unsigned v = 0; v < variable_count; ++v) place[references[v]] = v;
  return place;
}();

}  // namespace

unsigned variable_of(unsigned reference) { return reference < places.size() ? places[reference] : variable_count; }

const Row& row_of(unsigned variable) { return rows[variable]; }

Acting acting_of(Reading& reading) {
  const WheelDynamics& d = reading.dynamics();
  const WheelAxleMoment axle = {d.tau, d.lambda[2], reading.at.scene.wheel.s, reading.at.scene.load.brake};
  return {reading.kinematics(), {d.lambda[0], d.lambda[1], d.lambda[2]}, axle};
}

Limit broken_limit(unsigned v, double value) {
  using namespace variable;
  const Row& row = rows[v];
  const bool positive = v == m || v == r_0 || v == J_x || v == J_y || v == J_z || v == omega_s;
  if (positive && value <= row.min) return {"greater than", "%s = %s: it must be greater than %s.", row.min};
  if (value < row.min) return {"at least", "%s = %s: it must be at least %s.", row.min};
  if (v == slope && value >= row.max)  // a road is never upright
    return {"less than", "%s = %s rad: it must be less than %s.", row.max};
  if ((v == psi_start || v == phi_start || v == slope_direction) && std::fabs(value) > largest_angle)
    return {value > 0 ? "at most" : "at least", "%s = %s rad: beyond %s rad an angle has too few digits.",
            std::copysign(largest_angle, value)};
  return value > row.max ? Limit{"at most", "%s = %s: it must be at most %s.", row.max} : Limit{};
}

bool is_variable(unsigned variable, Type type) { return variable < variable_count && rows[variable].type == type; }

}  // namespace wheel
