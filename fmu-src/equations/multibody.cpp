// The multibody formulation behind the C header: (24) under a law of friction, as first-order system, any inertia.
// Fixed axes for O, Euler angles for the attitude; see multibody.hpp for the equations.
#include "multibody.hpp"

#include <Eigen/LU>

#include "friction.h"

namespace wheel::paper {
namespace {

constexpr int about_axle = 5;                       // row of the moment about the axle in (24)
enum Unknown { lambda_1 = 6, lambda_2, lambda_3 };  // behind q_ddot in the order of q

// Solution of (24) and the moment of ground and brake about the axle.
struct Solution {
  Vector9 unknowns;  // q_ddot, lambda
  double tau;
};

// omega_z held: the moment tau about the axle is found from omega_z_dot = 0, linearly.
Solution solve_held(const Multibody& s, const Vector9& column) {
  const Eigen::PartialPivLU<Matrix9> K(system_matrix(s, 0));
  const Vector9 free = K.solve(column), unit = K.solve(Vector9::Unit(about_axle));
  const double tau = -omega_z_dot(s, free) / s.Q.row(2).dot(unit.segment<3>(3));
  return {free + unit * tau, tau};
}

// The moment -(s N + brake) kappa about the axle; where the ground pulls, only the brake's part is left.
Solution solve_rolling(const WheelScene& scene, const Multibody& s, Vector9 column) {
  const double kappa = kappa_of(&scene.friction, omega_z(s)), brake = scene.load.brake;
  column[about_axle] -= brake * kappa;
  if (scene.ground != WHEEL_GROUND_PULLS) {
    const Vector9 unknowns = system_matrix(s, kappa).partialPivLu().solve(column);
    if (kappa == 0) return {unknowns, 0};
    if (unknowns[lambda_3] > 0 || scene.ground == WHEEL_GROUND_PRESSES)
      return {unknowns, -(s.wheel.s * unknowns[lambda_3] + brake) * kappa};
  }
  return {system_matrix(s, 0).partialPivLu().solve(column), -brake * kappa};
}

// (24) under the scene's law of friction.
Solution solve(const WheelScene& scene, const Multibody& s, const Vector9& column) {
  return scene.friction.kind == WHEEL_HELD ? solve_held(s, column) : solve_rolling(scene, s, column);
}

// Rate at which errors of the constraints decay, 1/s: a few times the rates of the motion itself, so that it is never
// the stiffest part.
double decay_rate(const Multibody& s) {
  const double omega_squared = (s.Q * s.attitude.beta_dot).squaredNorm();
  return 5 * std::sqrt(s.wheel.g / (s.wheel.r_0 + s.wheel.r) + omega_squared);
}

// (24) with -[B_dot]{q_dot} - decay_rate [B]{q_dot} in the last rows, and a height that decays to that of (32)
// (Baumgarte). Both added terms vanish on the constraints.
double derivative(const WheelScene* scene, const double* y, double* y_dot) {
  const Multibody s(scene->wheel, y);
  const double rate = decay_rate(s);
  Vector9 column = system_column(s, scene->load);
  column.tail<3>() -= rate * (B(s) * s.q_dot);
  const Solution solution = solve(*scene, s, column);
  Eigen::Map<Vector6> velocities(y_dot), accelerations(y_dot + 6);
  velocities = s.q_dot;
  velocities[Z_O] -= rate * (y[Z_O] - (scene->wheel.r_0 * s.attitude.sin_theta + scene->wheel.r));
  accelerations = solution.unknowns.head<6>();
  y_dot[spin] = scene->friction.kind == WHEEL_HELD ? 0 : omega_z_dot(s, solution.unknowns);
  return solution.unknowns[lambda_3];
}

// (19) solved for the velocity of O: -[A][r]^T[Q]{beta_dot}.
void set_rolling_velocity(const WheelParameters& wheel, double* y) {
  const Multibody s(wheel, y);
  Eigen::Map<Vector3>(y + X_O_dot) = -s.A * s.r.transpose() * s.Q * s.attitude.beta_dot;
}

void start(const WheelParameters* wheel, const WheelMotion* motion, double* y) {
  const double spin = motion->phi_dot + motion->psi_dot * std::cos(motion->theta);
  Eigen::Map<Vector6>(y) << motion->X_O, motion->Y_O, wheel_height(wheel, motion->theta), motion->psi, motion->theta,
      motion->phi;
  Eigen::Map<Vector3>(y + psi_dot) << motion->psi_dot, motion->theta_dot, spin;
  set_rolling_velocity(*wheel, y);
}

void kinematics(const WheelParameters* wheel, const double* y, WheelKinematics* out) {
  (void)wheel;
  const double phi_dot = y[spin] - y[psi_dot] * std::cos(y[theta]);
  *out = {y[X_O],     y[Y_O],     y[Z_O],     y[psi],       y[theta], y[phi], y[X_O_dot],
          y[Y_O_dot], y[Z_O_dot], y[psi_dot], y[theta_dot], phi_dot,  y[spin]};
}

void dynamics(const WheelScene* scene, const double* y, WheelDynamics* out) {
  const Multibody s(scene->wheel, y);
  const auto [x, tau] = solve(*scene, s, system_column(s, scene->load));
  const double spin_dot = scene->friction.kind == WHEEL_HELD ? 0 : omega_z_dot(s, x);
  *out = {x[X_O], x[Y_O], x[Z_O], x[psi], x[theta], x[phi], spin_dot, {x[lambda_1], x[lambda_2], x[lambda_3]}, tau};
}

void stop_spin(const WheelParameters* wheel, double* y) {
  y[spin] = 0;
  set_rolling_velocity(*wheel, y);
}

// The state of the reduced form with the same position and angular velocity.
struct Reduced {
  double y[WHEEL_REDUCED_STATES];
  explicit Reduced(const double* b)
      : y{b[theta], b[theta_dot], b[psi_dot] * std::sin(b[theta]), b[spin], b[psi], b[phi], b[X_O], b[Y_O]} {}
};

void rates(const WheelScene* scene, const WheelLoad* load_dot, const double* y, WheelReactionRates* out) {
  wheel_reduced.rates(scene, load_dot, Reduced(y).y, out);
}

void response(const WheelScene* scene, const WheelLoad* load_dot, const double* y, WheelReactionRates* out) {
  wheel_reduced.response(scene, load_dot, Reduced(y).y, out);
}

// Its velocities are states: the pose takes no more than they do.
constexpr WheelFormulation formulation = {"multibody", WHEEL_MULTIBODY_STATES,
                                          start,       derivative,
                                          spin,        theta,
                                          kinematics,  kinematics,
                                          dynamics,    rates,
                                          response,    stop_spin};

}  // namespace
}  // namespace wheel::paper

const WheelFormulation wheel_multibody = wheel::paper::formulation;
