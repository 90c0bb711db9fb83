// The multibody formulation behind the C header: (24) under a law of friction, as first-order system, any inertia.
// Fixed axes for O, Euler angles for the attitude; see multibody.hpp for the equations.
#include "multibody.hpp"

#include <Eigen/LU>

#include "friction.h"

namespace wheel::paper {
namespace {

constexpr int about_axle = 5, N = 8;  // row of the moment about the axle in (24), and lambda_3 among its unknowns

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
    if (unknowns[N] > 0 || scene.ground == WHEEL_GROUND_PRESSES)
      return {unknowns, -(s.wheel.s * unknowns[N] + brake) * kappa};
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
  velocities[2] -= rate * (y[2] - (scene->wheel.r_0 * s.attitude.sin_theta + scene->wheel.r));
  accelerations = solution.unknowns.head<6>();
  accelerations[5] = scene->friction.kind == WHEEL_HELD ? 0 : omega_z_dot(s, solution.unknowns);
  return solution.unknowns[N];
}

// (19) solved for the velocity of O: -[A][r]^T[Q]{beta_dot}.
void set_rolling_velocity(const WheelParameters& wheel, double* y) {
  const Multibody s(wheel, y);
  Eigen::Map<Vector3>(y + 6) = -s.A * s.r.transpose() * s.Q * s.attitude.beta_dot;
}

void start(const WheelParameters* wheel, const WheelMotion* motion, double* y) {
  y[0] = motion->X_O, y[1] = motion->Y_O, y[2] = wheel_height(wheel, motion->theta);
  y[3] = motion->psi, y[4] = motion->theta, y[5] = motion->phi;
  y[9] = motion->psi_dot, y[10] = motion->theta_dot;
  y[11] = motion->phi_dot + motion->psi_dot * std::cos(motion->theta);
  set_rolling_velocity(*wheel, y);
}

void kinematics(const WheelParameters* wheel, const double* y, WheelKinematics* out) {
  (void)wheel;
  out->X_O = y[0], out->Y_O = y[1], out->Z_O = y[2];
  out->psi = y[3], out->theta = y[4], out->phi = y[5];
  out->X_O_dot = y[6], out->Y_O_dot = y[7], out->Z_O_dot = y[8];
  out->psi_dot = y[9], out->theta_dot = y[10], out->phi_dot = y[11] - y[9] * std::cos(y[4]);
  out->omega_z = y[11];
}

void dynamics(const WheelScene* scene, const double* y, WheelDynamics* out) {
  const Multibody s(scene->wheel, y);
  const auto [x, tau] = solve(*scene, s, system_column(s, scene->load));
  out->X_O_ddot = x[0], out->Y_O_ddot = x[1], out->Z_O_ddot = x[2];
  out->psi_ddot = x[3], out->theta_ddot = x[4], out->phi_ddot = x[5];
  for (int i = 0; i < 3; ++i) out->lambda[i] = x[6 + i];
  out->omega_z_dot = scene->friction.kind == WHEEL_HELD ? 0 : omega_z_dot(s, x);
  out->tau = tau;
}

void stop_spin(const WheelParameters* wheel, double* y) {
  y[11] = 0;
  set_rolling_velocity(*wheel, y);
}

// The state of the reduced form with the same position and angular velocity.
struct Reduced {
  double y[WHEEL_REDUCED_STATES];
  explicit Reduced(const double* b) : y{b[4], b[10], b[9] * std::sin(b[4]), b[11], b[3], b[5], b[0], b[1]} {}
};

void rates(const WheelScene* scene, const WheelLoad* load_dot, const double* y, WheelReactionRates* out) {
  wheel_reduced.rates(scene, load_dot, Reduced(y).y, out);
}

void response(const WheelScene* scene, const WheelLoad* load_dot, const double* y, WheelReactionRates* out) {
  wheel_reduced.response(scene, load_dot, Reduced(y).y, out);
}

}  // namespace
}  // namespace wheel::paper

extern "C" {

extern const WheelFormulation wheel_multibody;
const WheelFormulation wheel_multibody = {
    .name = "multibody",
    .states = WHEEL_MULTIBODY_STATES,
    .start = wheel::paper::start,
    .derivative = wheel::paper::derivative,
    .spin_index = 11,
    .tilt_index = 4,
    .kinematics = wheel::paper::kinematics,
    .pose = wheel::paper::kinematics,  // the pose: its velocities are states
    .dynamics = wheel::paper::dynamics,
    .rates = wheel::paper::rates,
    .response = wheel::paper::response,
    .stop_spin = wheel::paper::stop_spin,
};

}  // extern "C"
