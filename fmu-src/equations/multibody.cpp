// The multibody formulation behind the C header: (24) as first-order system, any inertia.
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

struct External {
  Vector3<double> force = Vector3<double>::Zero(), moment = Vector3<double>::Zero();
  explicit External(const WheelScene& scene) {
    if (!scene.loaded) return;
    force = Eigen::Map<const Vector3<double>>(scene.load.F);
    moment = Eigen::Map<const Vector3<double>>(scene.load.M);
  }
};

void set_rolling_velocity(const WheelParameters& wheel, double* y) {
  const Attitude<double> attitude(y[3], y[4], y[5], {y[9], y[10], y[11] - y[9] * std::cos(y[4])});
  Eigen::Map<Vector3<double>>(y + 6) = rolling_velocity(wheel, attitude);
}

void start(const WheelParameters* wheel, const WheelMotion* motion, double* y) {
  y[0] = motion->X_O, y[1] = motion->Y_O, y[2] = wheel_height(wheel, motion->theta);
  y[3] = motion->psi, y[4] = motion->theta, y[5] = motion->phi;
  y[9] = motion->psi_dot, y[10] = motion->theta_dot;
  y[11] = motion->phi_dot + motion->psi_dot * std::cos(motion->theta);
  set_rolling_velocity(*wheel, y);
}

double derivative(const WheelScene* scene, const double* y, double* y_dot) {
  const External external(*scene);
  return state_rate<double>(*scene, external.force, external.moment, y, y_dot);
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
  const State state(scene->wheel, y);
  const External external(*scene);
  const Vector9<double> column = system_column<double>(state, external.force, external.moment);
  const Solution<double> solution = solve<double>(scene->friction, state, column);
  const auto& x = solution.unknowns;
  out->X_O_ddot = x[0], out->Y_O_ddot = x[1], out->Z_O_ddot = x[2];
  out->psi_ddot = x[3], out->theta_ddot = x[4], out->phi_ddot = x[5];
  for (int i = 0; i < 3; ++i) out->lambda[i] = x[6 + i];
  out->omega_z_dot = scene->friction.kind == WHEEL_HELD ? 0 : omega_z_dot(state, x);
  out->tau = solution.tau;
}

void stop_spin(const WheelParameters* wheel, double* y) {
  y[11] = 0;
  set_rolling_velocity(*wheel, y);
}

}  // namespace
}  // namespace wheel::paper

extern "C" {

void wheel_multibody_reaction_rates(const WheelScene* scene, const WheelLoad* load_dot, const double* y,
                                    double lambda_dot[3]);
void wheel_multibody_jacobian(const WheelScene* scene, const double* y, double* J);

extern const WheelFormulation wheel_multibody;
const WheelFormulation wheel_multibody = {
    "multibody",
    WHEEL_MULTIBODY_STATES,
    wheel::paper::start,
    wheel::paper::derivative,
    11,
    4,
    wheel::paper::kinematics,
    wheel::paper::kinematics,  // the pose: its velocities are states
    wheel::paper::dynamics,
    wheel_multibody_reaction_rates,
    wheel_multibody_jacobian,
    wheel::paper::stop_spin,
    WHEEL_MULTIBODY_STATES,  // the velocities of O are states: no quadratures
    wheel::paper::derivative,
};

}  // extern "C"
