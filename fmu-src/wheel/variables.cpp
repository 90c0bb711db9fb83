// The rows of the variable table. Start values are the paper's scene, (27)-(33), without friction.
#include "variables.hpp"

#include <iterator>

#include "reading.hpp"

namespace wheel {
namespace {

constexpr double none = std::numeric_limits<double>::infinity();
constexpr double pi = 3.141592653589793;

constexpr Row parameter(const char* name, double start, double min = -none, double max = none) {
  return {name, Type::real, Role::parameter, start, min, max, nullptr};
}
constexpr Row choice(const char* name, double max) {
  return {name, Type::integer, Role::parameter, 1, 1, max, nullptr};
}
// Far beyond any wheel: beyond it the products of loads and parameters would not be finite.
constexpr double strongest = 1e300;  // N, N m
constexpr Row input(const char* name) { return {name, Type::real, Role::input, 0, -strongest, strongest, nullptr}; }
constexpr Row output(const char* name, double (*read)(Reading&), double (*rate)(Reading&)) {
  return {name, Type::real, Role::output, 0, 0, 0, read, rate};
}
constexpr Row reaction(const char* name, int i, double (*read)(Reading&), double (*rate)(Reading&)) {
  return {name, Type::real, Role::output, 0, 0, 0, read, rate, i};
}
constexpr Row local(const char* name, Type type, double (*read)(Reading&)) {
  return {name, type, Role::local, 0, 0, 0, read};
}

#define AT(expression) [](Reading& now) -> double { return expression; }

constexpr Row variables[] = {
    parameter("m", 20, 0),
    parameter("r_0", 0.3, 0),
    parameter("r", 0.05, 0),
    parameter("J_x", 0.9, 0),
    parameter("J_y", 0.9, 0),
    parameter("J_z", 1.8, 0),
    parameter("g", 9.81, 0),
    {"s", Type::real, Role::tunable, 0, 0, none, nullptr},
    parameter("psi_start", pi / 2),
    parameter("theta_start", 5 * pi / 12, 0, pi),
    parameter("phi_start", 0),
    parameter("psi_dot_start", 0),
    parameter("theta_dot_start", 0),
    parameter("phi_dot_start", -2),
    parameter("X_O_start", -0.07764571353075622),
    parameter("Y_O_start", 0),
    choice("formulation", multibody_formulation),
    choice("friction_law", regularized_law),
    parameter("omega_s", 0.001, 0),
    choice("method", bdf_method),
    {"keep_contact", Type::boolean, Role::parameter, 0, 0, 1, nullptr},
    input("F_X"),
    input("F_Y"),
    input("F_Z"),
    input("M_1"),
    input("M_2"),
    input("M_3"),
    output("X_O", AT(now.pose().X_O), AT(now.kinematics().X_O_dot)),
    output("theta", AT(now.pose().theta), AT(now.pose().theta_dot)),
    output("phi_dot", AT(now.pose().phi_dot), AT(now.dynamics().phi_ddot)),
    output("psi_dot", AT(now.pose().psi_dot), AT(now.dynamics().psi_ddot)),
    output("Y_O", AT(now.pose().Y_O), AT(now.kinematics().Y_O_dot)),
    output("Z_O", AT(now.pose().Z_O), AT(now.pose().Z_O_dot)),
    output("psi", AT(now.pose().psi), AT(now.pose().psi_dot)),
    output("phi", AT(now.pose().phi), AT(now.pose().phi_dot)),
    output("theta_dot", AT(now.pose().theta_dot), AT(now.dynamics().theta_ddot)),
    output("X_O_dot", AT(now.kinematics().X_O_dot), AT(now.dynamics().X_O_ddot)),
    output("Y_O_dot", AT(now.kinematics().Y_O_dot), AT(now.dynamics().Y_O_ddot)),
    output("Z_O_dot", AT(now.pose().Z_O_dot), AT(now.dynamics().Z_O_ddot)),
    output("omega_z", AT(now.pose().omega_z), AT(now.dynamics().omega_z_dot)),
    reaction("lambda_1", 0, AT(now.dynamics().lambda[0]), AT(now.reaction_rates()[0])),
    reaction("lambda_2", 1, AT(now.dynamics().lambda[1]), AT(now.reaction_rates()[1])),
    reaction("lambda_3", 2, AT(now.dynamics().lambda[2]), AT(now.reaction_rates()[2])),
    local("E", Type::real, AT(wheel_energy(&now.scene().wheel, &now.kinematics()))),
    local("mu_required", Type::real, AT(wheel_required_friction(now.dynamics().lambda))),
    local("friction_mode", Type::integer, AT(now.friction_mode())),
    local("n_steps", Type::integer, AT(double(now.counters().steps))),
    local("n_rhs", Type::integer, AT(double(now.counters().rhs))),
    local("n_jac", Type::integer, AT(double(now.counters().jacobians))),
    local("n_roots", Type::integer, AT(double(now.counters().roots))),
    local("n_events", Type::integer, AT(double(now.counters().events))),
    local("n_restarts", Type::integer, AT(double(now.counters().restarts))),
};

#undef AT

}  // namespace

unsigned variable_count() { return static_cast<unsigned>(std::size(variables)); }

const Row& row_of(unsigned variable) { return variables[variable]; }

bool is_variable(unsigned variable, Type type) {
  return variable < variable_count() && variables[variable].type == type;
}

}  // namespace wheel
