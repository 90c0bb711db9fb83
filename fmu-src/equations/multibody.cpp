// The multibody formulation behind the C header: (24) as first-order system in y = (q, q_dot), any inertia.
// Fixed axes for O, Euler angles for the attitude; see multibody.hpp for the equations.
#include "multibody.hpp"

#include <cstddef>

namespace wheel::paper {
namespace {

using State = Multibody<double>;

// (19) solved for the velocity of O: -[A][r]^T[Q]{beta_dot}.
Vector3<double> rolling_velocity(const WheelParameters& wheel, const Attitude<double>& attitude) {
  return -A(attitude) * r(wheel, attitude).transpose() * Q(attitude) * attitude.beta_dot;
}

Solution<double> solve_scene(const WheelScene& scene, const State& state) {
  Vector3<double> force = Vector3<double>::Zero(), moment = Vector3<double>::Zero();
  if (scene.loaded) {
    force = Eigen::Map<const Vector3<double>>(scene.load.F);
    moment = Eigen::Map<const Vector3<double>>(scene.load.M);
  }
  return solve<double>(scene.friction, state, force, moment);
}

void set_rolling_velocity(const WheelParameters& wheel, double* y) {
  const Attitude<double> attitude(y[3], y[4], y[5], {y[9], y[10], y[11]});
  Eigen::Map<Vector3<double>>(y + 6) = rolling_velocity(wheel, attitude);
}

void start(const WheelParameters* wheel, const WheelMotion* motion, double* y) {
  y[0] = motion->X_O, y[1] = motion->Y_O, y[2] = wheel_height(wheel, motion->theta);
  y[3] = motion->psi, y[4] = motion->theta, y[5] = motion->phi;
  y[9] = motion->psi_dot, y[10] = motion->theta_dot, y[11] = motion->phi_dot;
  set_rolling_velocity(*wheel, y);
}

double derivative(const WheelScene* scene, const double* y, double* y_dot) {
  const Solution<double> solution = solve_scene(*scene, State(scene->wheel, y));
  for (int i = 0; i < 6; ++i) {
    y_dot[i] = y[6 + i];
    y_dot[6 + i] = solution.unknowns[i];
  }
  return solution.unknowns[8];
}

double spin(const double* y) { return y[11] + y[9] * std::cos(y[4]); }
double tilt(const double* y) { return y[4]; }

void kinematics(const WheelParameters* wheel, const double* y, WheelKinematics* out) {
  (void)wheel;
  out->X_O = y[0], out->Y_O = y[1], out->Z_O = y[2];
  out->psi = y[3], out->theta = y[4], out->phi = y[5];
  out->X_O_dot = y[6], out->Y_O_dot = y[7], out->Z_O_dot = y[8];
  out->psi_dot = y[9], out->theta_dot = y[10], out->phi_dot = y[11];
  out->omega_z = spin(y);
}

void dynamics(const WheelScene* scene, const double* y, WheelDynamics* out) {
  const State state(scene->wheel, y);
  const Solution<double> solution = solve_scene(*scene, state);
  const auto& x = solution.unknowns;
  out->X_O_ddot = x[0], out->Y_O_ddot = x[1], out->Z_O_ddot = x[2];
  out->psi_ddot = x[3], out->theta_ddot = x[4], out->phi_ddot = x[5];
  for (int i = 0; i < 3; ++i) out->lambda[i] = x[6 + i];
  out->omega_z_dot = scene->friction.kind == WHEEL_HELD ? 0 : omega_z_dot(state, x);
  out->tau = solution.tau;
}

void stop_spin(const WheelParameters* wheel, double* y) {
  y[11] = -y[9] * std::cos(y[4]);
  set_rolling_velocity(*wheel, y);
}

}  // namespace
}  // namespace wheel::paper

extern "C" {

void wheel_multibody_reaction_rates(const WheelScene* scene, const WheelLoad* load_dot, const double* y,
                                    double lambda_dot[3]);

extern const WheelFormulation wheel_multibody;
const WheelFormulation wheel_multibody = {
    "multibody",
    WHEEL_MULTIBODY_STATES,
    wheel::paper::start,
    wheel::paper::derivative,
    wheel::paper::spin,
    wheel::paper::tilt,
    wheel::paper::kinematics,
    wheel::paper::dynamics,
    wheel_multibody_reaction_rates,
    wheel::paper::stop_spin,
};

}  // extern "C"
