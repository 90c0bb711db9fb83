// The multibody formulation behind the C header: the paper's system of equations of motion, (15)-(24), any inertia,
// under a law of rolling resistance, solved at a state of the reduced forms. Fixed axes for O, Euler angles for the
// attitude. Eigen.
//
// Unknowns q_ddot (6) and lambda (3); rows: motion of O (fixed axes), rotation (body axes), constraint [B]{q_ddot} =
// -[B_dot]{q_dot}. Mended misprints, see docs/errata.md: the sign and the bracket of F_beta (16), q_ddot in (24).
#include <Eigen/LU>
#include <algorithm>

#include "axle_law.h"
#include "constant.hpp"
#include "paper_matrices.hpp"

namespace wheel::paper {
namespace {

using Matrix9 = Eigen::Matrix<double, 9, 9>;
using Vector9 = Eigen::Matrix<double, 9, 1>;
using Matrix36 = Eigen::Matrix<double, 3, 6>;
using Matrix63 = Eigen::Matrix<double, 6, 3>;
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Vector2 = Eigen::Vector2d;

// The coordinates q, (25), in their order, which is also that of q_dot and q_ddot.
enum Coordinate { X_O, Y_O, Z_O, psi, theta, phi };

// The unknowns of (24), behind q_ddot in the order of q; and its row of the moment about the axle.
enum Unknown { lambda_1 = 6, lambda_2, lambda_3 };
constexpr int about_axle = 5;

// Euler angles and their rates, of omega_1 = theta_dot, omega_2 = psi_dot sin(theta) and (21).
Attitude attitude_of(const double* y) {
  const double theta = y[WHEEL_THETA], psi_dot = y[WHEEL_OMEGA_2] / std::sin(theta);
  const Vector3 beta_dot(psi_dot, y[WHEEL_OMEGA_1], y[WHEEL_OMEGA_3] - psi_dot * std::cos(theta));
  return {y[WHEEL_PSI], theta, y[WHEEL_PHI], beta_dot};
}

// A state of the reduced forms with the matrices that (16)-(24) share. The velocity of O follows from the constraints,
// (19), with the slip on their right-hand side.
struct Multibody {
  const WheelParameters& wheel;
  double omega_z;  // (21): the sum with phi_dot would round what a narrow regularized law multiplies
  Attitude attitude;
  Matrix3 A = paper::A(attitude), A_dot = paper::A_dot(A, attitude);
  Matrix3 Q = paper::Q(attitude), Q_dot = paper::Q_dot(attitude);
  Matrix3 r = paper::r(wheel, attitude), r_dot = paper::r_dot(wheel, attitude);
  Matrix36 B, B_dot;  // [B]{q_dot} is the velocity of the wheel's material point at the contact
  Vector6 q_dot;
  Vector2 d = Vector2::Zero();  // direction of the slip, fixed axes

  Multibody(const WheelParameters& w, const double* y, bool slides)
      : wheel(w), omega_z(y[WHEEL_OMEGA_3]), attitude(attitude_of(y)) {
    const Matrix3 A_r = A * r.transpose();
    // (19): [B] = [[I] [A][r]^T[Q]]
    B << Matrix3::Identity(), A_r * Q;
    // (20)
    B_dot << Matrix3::Zero(), A_dot * r.transpose() * Q + A * r_dot.transpose() * Q + A_r * Q_dot;
    q_dot << -B.rightCols<3>() * attitude.beta_dot, attitude.beta_dot;
    if (!slides) return;
    d << std::cos(y[WHEEL_PSI] + y[WHEEL_CHI]), std::sin(y[WHEEL_PSI] + y[WHEEL_CHI]);
    q_dot.head<2>() += y[WHEEL_SLIP] * d;
  }
};

// Of (21), omega_z = [0 0 1][Q]{beta_dot}, the derivative from the unknowns of (24).
double omega_z_dot(const Multibody& s, const Vector9& unknowns) {
  return s.Q.row(2).dot(unknowns.segment<3>(3)) + s.Q_dot.row(2).dot(s.attitude.beta_dot);
}

// (22): the moment -s N kappa about the axle as a matrix on lambda. The third component of lambda in body axes is not
// N, so [B*] acts on lambda in fixed axes: row z, column Z.
Matrix3 B_star(const AxleLaw& law) { return Vector3(0, 0, -law.lever).asDiagonal(); }

// (23): how lambda enters the equations of motion.
Matrix63 B_tilde(const Multibody& s, const AxleLaw& law) {
  Matrix63 B_tilde;
  B_tilde << Matrix3::Identity(), s.r * s.A.transpose() + B_star(law);
  return B_tilde;
}

// (15), generalized: weight (tilted on a slope), F at O (fixed axes), M turned from the non-spinning frame into body
// axes by [phi]^T.
Vector6 F(const Multibody& s, const WheelLoad& load) {
  const Matrix3 phi = rotation_z(s.attitude.sin_phi, s.attitude.cos_phi);
  Vector6 F;
  F << Vector3(load.F) + s.wheel.m * Vector3(s.wheel.g_X, s.wheel.g_Y, -s.wheel.g_n), phi.transpose() * Vector3(load.M);
  return F;
}

// (16), misprint F_beta mended: -([J][Q_dot] + [A]^T[A_dot][J][Q]){beta_dot}.
Vector3 F_beta(const Multibody& s) {
  const Matrix3 inertia = J(s.wheel);
  return -(inertia * s.Q_dot + s.A.transpose() * s.A_dot * inertia * s.Q) * s.attitude.beta_dot;
}

// (24), ready for a law of rolling resistance.
struct Equations {
  const WheelScene& scene;
  Multibody s;
  bool slides;
  Vector9 column;  // right-hand side
};

Equations equations_of(const WheelScene& scene, const double* y, bool slides) {
  Equations now = {scene, Multibody(scene.wheel, y, slides), slides, {}};
  now.column << F(now.s, scene.load), -now.s.B_dot * now.s.q_dot;
  now.column.segment<3>(3) += F_beta(now.s);
  if (slides) now.column.segment<2>(6).setZero();
  return now;
}

// Matrix of (24), with [M] from (18). Where the wheel slides, lambda_1 + mu d_X lambda_3 = 0 and the same along Y stand
// in the place of the horizontal constraints.
Matrix9 system_matrix(const Equations& now, const AxleLaw& law, double mu) {
  const Multibody& s = now.s;
  Matrix9 K = Matrix9::Zero();
  K.block<3, 3>(0, 0) = s.wheel.m * Matrix3::Identity();
  K.block<3, 3>(3, 3) = J(s.wheel) * s.Q;
  K.block<6, 3>(0, 6) = -B_tilde(s, law);
  K.block<3, 6>(6, 0) = s.B;
  if (!now.slides) return K;
  K.block<2, 9>(6, 0).setZero();
  K.block<2, 2>(6, 6).setIdentity();
  K.block<2, 1>(6, 8) = mu * s.d;
  return K;
}

// A wheel carrier turns psi and theta: these two constraints stand in the place of the moments across the axle, where
// alone their multipliers act.
void guide(const WheelLoad& load, Matrix9& K, Vector9& column) {
  const Vector2 given(load.guide);
  column -= K.middleCols<2>(3) * given;
  column.segment<2>(3) = given;
  K.middleRows<2>(3).setZero();
  K.middleCols<2>(3).setZero();
  K.block<2, 2>(3, 3).setIdentity();
}

// Solution of (24) and the moment of ground and brake about the axle. The determinant of a wheel that slides is that
// without sliding friction times WheelSlip.room; if the wheel is held, both contain as a factor what a unit of tau adds
// to omega_z_dot.
struct Solution {
  Vector9 unknowns;  // q_ddot, lambda
  double tau, determinant;
};

// A ground that pulls has no friction: only the brake's part is left.
Solution solve(const Equations& now, bool pulls) {
  const Multibody& s = now.s;
  const double kappa = wheel_kappa(&now.scene.friction, s.omega_z);
  if (std::isnan(kappa)) return {Vector9::Constant(kappa), kappa, kappa};  // WHEEL_NO_LAW
  const AxleLaw law = axle_law_of(&now.scene, kappa, pulls);
  Vector9 column = now.column;
  column[about_axle] -= law.brake;
  Matrix9 matrix = system_matrix(now, law, pulls ? 0 : now.scene.mu_slide);
  if (now.scene.guided) guide(now.scene.load, matrix, column);
  const Eigen::PartialPivLU<Matrix9> K(matrix);
  const Vector9 unknowns = K.solve(column);
  if (law.held) {  // tau is found from omega_z_dot = 0, linearly; kappa = 0
    const Vector9 unit = K.solve(Vector9::Unit(about_axle));
    const double compliance = s.Q.row(2).dot(unit.segment<3>(3)), tau = -omega_z_dot(s, unknowns) / compliance;
    return {unknowns + unit * tau, tau, now.slides ? K.determinant() * compliance : 0};
  }
  return {unknowns, axle_moment_of(&law, unknowns[lambda_3]), now.slides ? K.determinant() : 0};
}

// (24) under the scene's law of rolling resistance.
Solution solve(const Equations& now) {
  const WheelGround ground = now.scene.ground;
  if (ground == WHEEL_GROUND_PULLS) return solve(now, true);
  Solution presses = solve(now, false);
  if (ground == WHEEL_GROUND_PRESSES || (now.scene.friction.kind == WHEEL_HELD && !now.slides)) return presses;
  // sliding friction keeps its sign
  const double N = (now.slides ? solve(now, true) : presses).unknowns[lambda_3];
  return N <= 0 ? solve(now, true) : presses;
}

double spin_rate(const Equations& now, const Solution& solution) {
  return now.scene.friction.kind == WHEEL_HELD ? 0 : omega_z_dot(now.s, solution.unknowns);
}

// The rate of omega_2 = psi_dot sin(theta); that of the slip is the rate of [B]{q_dot}, whose axes turn with psi.
// Returns N, infinite where the wheel jams.
template <bool slides>
double derivative(const WheelScene* scene, const double* y, double* y_dot) {
  const Equations now = equations_of(*scene, y, slides);
  const Multibody& s = now.s;
  const Solution solution = solve(now);
  const Vector6 &q_dot = s.q_dot, q_ddot = solution.unknowns.head<6>();
  const double N = solution.unknowns[lambda_3];
  y_dot[WHEEL_THETA] = q_dot[theta];
  y_dot[WHEEL_OMEGA_1] = q_ddot[theta];
  y_dot[WHEEL_OMEGA_2] = q_ddot[psi] * s.attitude.sin_theta + q_dot[psi] * s.attitude.cos_theta * q_dot[theta];
  y_dot[WHEEL_OMEGA_3] = spin_rate(now, solution);
  y_dot[WHEEL_PSI] = q_dot[psi];
  y_dot[WHEEL_PHI] = q_dot[phi];
  y_dot[WHEEL_X_O] = q_dot[X_O];
  y_dot[WHEEL_Y_O] = q_dot[Y_O];
  if (!slides) return N;
  const Vector3 slip_dot = s.B * q_ddot + s.B_dot * q_dot;
  const Vector2& d = s.d;
  const double turn = slip_dot[1] * d[0] - slip_dot[0] * d[1];
  y_dot[WHEEL_SLIP] = slip_dot.head<2>().dot(d);
  y_dot[WHEEL_CHI] = y[WHEEL_SLIP] == 0 ? 0 : turn / y[WHEEL_SLIP] - q_dot[psi];
  // Without friction the determinant is -sin(theta) times positive terms.
  const bool has_room = scene->guided || solution.determinant < 0;
  CONSTANT(double, usual, 100, "weights", "a larger normal force may be that of a wheel that jams");
  if (has_room && N >= 0 && N < usual * scene->wheel.m * scene->wheel.g_n) return N;
  return solve(now, true).unknowns[lambda_3] / N < WHEEL_LEAST_ROOM ? INFINITY : N;
}

template <bool slides>
void kinematics(const WheelParameters* wheel, const double* y, WheelKinematics* out) {
  const Multibody s(*wheel, y, slides);
  *out = {y[WHEEL_X_O], y[WHEEL_Y_O],   wheel_height(wheel, y[WHEEL_THETA]),
          y[WHEEL_PSI], y[WHEEL_THETA], y[WHEEL_PHI],
          s.q_dot[X_O], s.q_dot[Y_O],   s.q_dot[Z_O],
          s.q_dot[psi], s.q_dot[theta], s.q_dot[phi],
          s.omega_z};
}

template <bool slides>
void dynamics(const WheelScene* scene, const double* y, WheelDynamics* out) {
  const Equations now = equations_of(*scene, y, slides);
  const Solution solution = solve(now);
  const auto& [x, tau, determinant] = solution;
  *out = {x[X_O], x[Y_O], x[Z_O], x[psi], x[theta], x[phi], spin_rate(now, solution), {}, tau};
  std::copy_n(&x[lambda_1], 3, out->lambda);
}

template <bool slides>
void start(const WheelParameters* wheel, const WheelMotion* motion, double* y) {
  (slides ? wheel_sliding : wheel_reduced).start(wheel, motion, y);
}

template <bool slides>
constexpr WheelFormulation formulation = {
    .states = slides ? WHEEL_SLIDING_STATES : WHEEL_REDUCED_STATES,
    .start = start<slides>,
    .derivative = derivative<slides>,
    .kinematics = kinematics<slides>,
    .dynamics = dynamics<slides>,
};

}  // namespace
}  // namespace wheel::paper

const WheelFormulation wheel_multibody = wheel::paper::formulation<false>;
const WheelFormulation wheel_multibody_sliding = wheel::paper::formulation<true>;
