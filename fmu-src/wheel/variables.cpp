// How each calculated variable is read, and its rate of change: what modelDescription.xml cannot say. A variable of the
// description without a reader here does not compile, nor does a reader without its variable.
#include "variables.hpp"

#include <algorithm>
#include <iterator>

#include "reading.hpp"

namespace wheel {
namespace {

constexpr double unlimited = std::numeric_limits<double>::infinity();
// Largest input, N or N m: far above any real load. Products of larger loads with the parameters would overflow.
constexpr double strongest = 1e300;

struct Access {
  variable::Reference variable;
  double (*read)(Reading&);
  double (*read_rate)(Reading&) = nullptr;
  double (*by_force)(const Force&, const Force&) = nullptr;
};

#define AT(expression) [](Reading& now) -> double { return expression; }

constexpr Access readers[] = {
    {variable::X_O, AT(now.setup().X_O.whole(now.kinematics().X_O)), AT(now.kinematics().X_O_dot)},
    {variable::Y_O, AT(now.setup().Y_O.whole(now.kinematics().Y_O)), AT(now.kinematics().Y_O_dot)},
    {variable::Z_O, AT(now.kinematics().Z_O), AT(now.kinematics().Z_O_dot)},
    {variable::psi, AT(now.setup().psi.whole(now.kinematics().psi)), AT(now.kinematics().psi_dot)},
    {variable::theta, AT(now.kinematics().theta), AT(now.kinematics().theta_dot)},
    {variable::phi, AT(now.setup().phi.whole(now.kinematics().phi)), AT(now.kinematics().phi_dot)},
    {variable::X_O_dot, AT(now.kinematics().X_O_dot), AT(now.dynamics().X_O_ddot)},
    {variable::Y_O_dot, AT(now.kinematics().Y_O_dot), AT(now.dynamics().Y_O_ddot)},
    {variable::Z_O_dot, AT(now.kinematics().Z_O_dot), AT(now.dynamics().Z_O_ddot)},
    {variable::psi_dot, AT(now.kinematics().psi_dot), AT(now.dynamics().psi_ddot)},
    {variable::theta_dot, AT(now.kinematics().theta_dot), AT(now.dynamics().theta_ddot)},
    {variable::phi_dot, AT(now.kinematics().phi_dot), AT(now.dynamics().phi_ddot)},
    {variable::omega_z, AT(now.kinematics().omega_z), AT(now.dynamics().omega_z_dot)},
    {variable::lambda_1, AT(now.dynamics().lambda[0])},
    {variable::lambda_2, AT(now.dynamics().lambda[1])},
    {variable::lambda_3, AT(now.dynamics().lambda[2])},
    {variable::X_C, AT(now.setup().X_O.whole(now.contact().X_C)), AT(now.contact().X_C_dot)},
    {variable::Y_C, AT(now.setup().Y_O.whole(now.contact().Y_C)), AT(now.contact().Y_C_dot)},
    {variable::lambda_x, AT(now.horizontal_force(0))},
    {variable::lambda_y, AT(now.horizontal_force(1))},
    {variable::tau, AT(now.dynamics().tau)},
    {variable::tau_brake, AT(now.brake_moment()), nullptr,
     [](const Force& force, const Force& rate) { return wheel_brake_moment_rate(&force.axle, &rate.axle); }},
    {variable::slip_x, AT(now.slip(0))},
    {variable::slip_y, AT(now.slip(1))},
    {variable::M_guide_1, AT(now.guide_moment(0))},
    {variable::M_guide_2, AT(now.guide_moment(1))},
    {variable::theta_ddot, AT(now.dynamics().theta_ddot)},
    {variable::psi_ddot, AT(now.dynamics().psi_ddot)},
    {variable::phi_ddot, AT(now.dynamics().phi_ddot)},
    {variable::omega_z_dot, AT(now.dynamics().omega_z_dot)},
    {variable::E, AT(now.energy())},
    {variable::mu_required, AT(wheel_required_friction(now.dynamics().lambda)), nullptr,
     [](const Force& force, const Force& rate) { return wheel_required_friction_rate(force.lambda, rate.lambda); }},
    {variable::contact_mode, AT(now.contact_mode())},
    {variable::friction_mode, AT(now.friction_mode())},
    {variable::n_steps, AT(double(now.counters().steps))},
    {variable::n_rhs, AT(double(now.counters().rhs))},
    {variable::n_jac, AT(double(now.counters().jacobians))},
    {variable::n_roots, AT(double(now.counters().roots))},
    {variable::n_events, AT(double(now.transitions()))},
    {variable::n_restarts, AT(double(now.counters().restarts))},
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
  return {name, type, role, 0, 0, 0, r.read, r.read_rate, r.by_force};
}

constexpr Row rows[] = {
#define STORED(name, type, role, start, min, max) stored_row(#name, Type::type, Role::role, start, min, max),
#define COMPUTED(name, type, role) computed_row<variable::name>(#name, Type::type, Role::role),
#include "variables.inc"
};

static_assert(std::size(rows) == variable_count && std::size(readers) == variable_count - stored_count);

}  // namespace

const Row& row_of(unsigned variable) { return rows[variable]; }

bool is_above(unsigned v, double value) { return v == variable::slope ? value >= rows[v].max : value > rows[v].max; }

bool is_variable(unsigned variable, Type type) { return variable < variable_count && rows[variable].type == type; }

}  // namespace wheel
