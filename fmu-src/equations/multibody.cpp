// The multibody formulation behind the C header: the paper's system of equations of motion, (15)-(24), any inertia,
// under a law of friction, as first-order system. Fixed axes for O, Euler angles for the attitude. Eigen.
//
// Unknowns q_ddot (6) and lambda (3); rows: motion of O (fixed axes), rotation (body axes), constraint [B]{q_ddot} =
// -[B_dot]{q_dot}. Mended misprints, see docs/errata.md: the sign and the bracket of F_beta (16), q_ddot in (24).
#include <Eigen/LU>

#include "paper_matrices.hpp"

namespace wheel::paper {
namespace {

using Matrix9 = Eigen::Matrix<double, 9, 9>;
using Vector9 = Eigen::Matrix<double, 9, 1>;
using Matrix36 = Eigen::Matrix<double, 3, 6>;
using Matrix63 = Eigen::Matrix<double, 6, 3>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

// A state y = (q, q_dot; omega_z, the spin, in the place of phi_dot).
enum State { X_O, Y_O, Z_O, psi, theta, phi, X_O_dot, Y_O_dot, Z_O_dot, psi_dot, theta_dot, spin };

// The state with the matrices that (16)-(24) share.
struct Multibody {
  const WheelParameters& wheel;
  Attitude attitude;
  Vector6 q_dot;
  Matrix3 A = paper::A(attitude), A_dot = paper::A_dot(A, attitude);
  Matrix3 Q = paper::Q(attitude), Q_dot = paper::Q_dot(attitude);
  Matrix3 r = paper::r(wheel, attitude), r_dot = paper::r_dot(wheel, attitude);

  Multibody(const WheelParameters& w, const double* y)
      : wheel(w),
        attitude{y[psi], y[theta], y[phi], {y[psi_dot], y[theta_dot], y[spin] - y[psi_dot] * std::cos(y[theta])}} {
    q_dot << y[X_O_dot], y[Y_O_dot], y[Z_O_dot], attitude.beta_dot;
  }
};

// (19): [B] = [[I] [A][r]^T[Q]]; [B]{q_dot} is the velocity of the wheel's material point at the contact.
Matrix36 B(const Multibody& s) {
  Matrix36 B;
  B << Matrix3::Identity(), s.A * s.r.transpose() * s.Q;
  return B;
}

// (20)
Matrix36 B_dot(const Multibody& s) {
  Matrix36 B_dot;
  B_dot << Matrix3::Zero(),
      s.A_dot * s.r.transpose() * s.Q + s.A * s.r_dot.transpose() * s.Q + s.A * s.r.transpose() * s.Q_dot;
  return B_dot;
}

// (21): omega_z = [0 0 1][Q]{beta_dot}, and its derivative from the unknowns of (24).
double omega_z(const Multibody& s) { return s.Q.row(2).dot(s.attitude.beta_dot); }
double omega_z_dot(const Multibody& s, const Vector9& unknowns) {
  return s.Q.row(2).dot(unknowns.segment<3>(3)) + s.Q_dot.row(2).dot(s.attitude.beta_dot);
}

// (22): the moment -s N kappa about the axle as a matrix on lambda. The third component of lambda in body axes is not
// N, so [B*] acts on lambda in fixed axes: row z, column Z.
Matrix3 B_star(const WheelParameters& w, double kappa) { return Vector3(0, 0, -w.s * kappa).asDiagonal(); }

// (23): how lambda enters the equations of motion.
Matrix63 B_tilde(const Multibody& s, double kappa) {
  Matrix63 B_tilde;
  B_tilde << Matrix3::Identity(), s.r * s.A.transpose() + B_star(s.wheel, kappa);
  return B_tilde;
}

// (15), generalised: weight (tilted on a slope), F at O (fixed axes), M turned from the carrier into body axes by
// [phi]^T.
Vector6 F(const Multibody& s, const WheelLoad& load) {
  const Matrix3 phi = rotation_z(s.attitude.sin_phi, s.attitude.cos_phi);
  Vector6 F;
  F << Vector3(load.F) + s.wheel.m * Vector3(s.wheel.g_X, s.wheel.g_Y, -s.wheel.g), phi.transpose() * Vector3(load.M);
  return F;
}

// (16), misprint F_beta mended: -([J][Q_dot] + [A]^T[A_dot][J][Q]){beta_dot}.
Vector3 F_beta(const Multibody& s) {
  const Matrix3 inertia = J(s.wheel);
  return -(inertia * s.Q_dot + s.A.transpose() * s.A_dot * inertia * s.Q) * s.attitude.beta_dot;
}

// Matrix of (24), with [M] from (18).
Matrix9 system_matrix(const Multibody& s, double kappa) {
  Matrix9 K = Matrix9::Zero();
  K.block<3, 3>(0, 0) = s.wheel.m * Matrix3::Identity();
  K.block<3, 3>(3, 3) = J(s.wheel) * s.Q;
  K.block<6, 3>(0, 6) = -B_tilde(s, kappa);
  K.block<3, 6>(6, 0) = B(s);
  return K;
}

// Right-hand side of (24).
Vector9 system_column(const Multibody& s, const WheelLoad& load) {
  Vector9 column;
  column << F(s, load), -B_dot(s) * s.q_dot;
  column.segment<3>(3) += F_beta(s);
  return column;
}

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
  const double kappa = wheel_kappa(&scene.friction, omega_z(s)), brake = scene.load.brake;
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
  const double gravity = Vector3(s.wheel.g_X, s.wheel.g_Y, s.wheel.g).stableNorm();
  return 5 * std::sqrt(gravity / (s.wheel.r_0 + s.wheel.r) + omega_squared);
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

void kinematics(const WheelParameters*, const double* y, WheelKinematics* out) {
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

void reduce(const double* y, double* reduced) {
  Eigen::Map<Eigen::Vector<double, WHEEL_REDUCED_STATES>>(reduced) << y[theta], y[theta_dot],
      y[psi_dot] * std::sin(y[theta]), y[spin], y[psi], y[phi], y[X_O], y[Y_O];
}

}  // namespace
}  // namespace wheel::paper

using namespace wheel::paper;

// Its velocities are states: the pose takes no more than they do.
const WheelFormulation wheel_multibody = {
    "multibody", WHEEL_MULTIBODY_STATES, start, derivative, spin, theta, kinematics, kinematics, dynamics, reduce,
    stop_spin};
