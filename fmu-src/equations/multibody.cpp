// The multibody formulation behind the C header: the paper's system of equations of motion, (15)-(24), any inertia,
// under a law of friction, as first-order system. Fixed axes for O, Euler angles for the attitude. Eigen.
//
// Unknowns q_ddot (6) and lambda (3); rows: motion of O (fixed axes), rotation (body axes), constraint [B]{q_ddot} =
// -[B_dot]{q_dot}. Mended misprints, see docs/errata.md: the sign and the bracket of F_beta (16), q_ddot in (24).
#include <Eigen/LU>
#include <array>

#include "paper_matrices.hpp"

namespace wheel::paper {
namespace {

using Matrix9 = Eigen::Matrix<double, 9, 9>;
using Vector9 = Eigen::Matrix<double, 9, 1>;
using Matrix36 = Eigen::Matrix<double, 3, 6>;
using Matrix63 = Eigen::Matrix<double, 6, 3>;
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Vector2 = Eigen::Vector2d;

// A state y = (q, q_dot; omega_z, the spin, in the place of phi_dot).
enum State { X_O, Y_O, Z_O, psi, theta, phi, X_O_dot, Y_O_dot, Z_O_dot, psi_dot, theta_dot, spin };

using States = std::array<double, WHEEL_MULTIBODY_STATES>;

// While the wheel slides, |u| and chi stand in the place of X_O_dot and Y_O_dot.
enum SlipState { speed = X_O_dot, chi = Y_O_dot };

// The unknowns of (24), behind q_ddot in the order of q; and its row of the moment about the axle.
enum Unknown { lambda_1 = 6, lambda_2, lambda_3 };
constexpr int about_axle = 5;

// The state with the matrices that (16)-(24) share.
struct Multibody {
  const WheelParameters& wheel;
  double omega_z;  // (21): the sum with phi_dot would round what a narrow regularized law multiplies
  Attitude attitude;
  Vector6 q_dot;
  Matrix3 A = paper::A(attitude), A_dot = paper::A_dot(A, attitude);
  Matrix3 Q = paper::Q(attitude), Q_dot = paper::Q_dot(attitude);
  Matrix3 r = paper::r(wheel, attitude), r_dot = paper::r_dot(wheel, attitude);
  Matrix36 B, B_dot;  // [B]{q_dot} is the velocity of the wheel's material point at the contact

  Multibody(const WheelParameters& w, const double* y)
      : wheel(w),
        omega_z(y[spin]),
        attitude{y[psi], y[theta], y[phi], {y[psi_dot], y[theta_dot], y[spin] - y[psi_dot] * std::cos(y[theta])}} {
    q_dot << y[X_O_dot], y[Y_O_dot], y[Z_O_dot], attitude.beta_dot;
    const Matrix3 A_r = A * r.transpose();
    // (19): [B] = [[I] [A][r]^T[Q]]
    B << Matrix3::Identity(), A_r * Q;
    // (20)
    B_dot << Matrix3::Zero(), A_dot * r.transpose() * Q + A * r_dot.transpose() * Q + A_r * Q_dot;
  }
};

// Of (21), omega_z = [0 0 1][Q]{beta_dot}, the derivative from the unknowns of (24).
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

// (15), generalized: weight (tilted on a slope), F at O (fixed axes), M turned from the non-spinning frame into body
// axes by [phi]^T.
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

// Rate at which errors of the constraints decay, 1/s: a few times the rates of the motion itself, so that it is never
// the stiffest part. On a wheel carrier the spin tilts nothing, and what turns is the carrier.
double decay_rate(const Multibody& s, int guided) {
  const Vector3& beta_dot = s.attitude.beta_dot;
  double omega_squared = (s.Q * beta_dot).squaredNorm();
  if (guided) omega_squared = std::fmin(omega_squared, 16 * beta_dot.head<2>().squaredNorm());
  const double gravity = Vector3(s.wheel.g_X, s.wheel.g_Y, s.wheel.g).stableNorm();
  return 5 * std::sqrt(gravity / (s.wheel.r_0 + s.wheel.r) + omega_squared);
}

// (19) solved for the velocity of O: -[A][r]^T[Q]{beta_dot}.
void set_rolling_velocity(const WheelParameters* wheel, double* y) {
  const Multibody s(*wheel, y);
  Eigen::Map<Vector3>(y + X_O_dot) = -s.B.rightCols<3>() * s.attitude.beta_dot;
}

// Of a slip, fixed axes.
Vector2 direction(const double* y) { return {std::cos(y[psi] + y[chi]), std::sin(y[psi] + y[chi])}; }

// The state with all velocities. Of a wheel that slides: (19) with the slip on its right-hand side, but for Z_O_dot,
// which is a state.
States whole(const WheelParameters& wheel, const double* state, bool slides) {
  States y;
  std::copy_n(state, y.size(), y.data());
  if (!slides) return y;
  set_rolling_velocity(&wheel, y.data());
  Eigen::Map<Vector2>(y.data() + X_O_dot) += state[speed] * direction(state);
  y[Z_O_dot] = state[Z_O_dot];
  return y;
}

// (24), ready for a law of friction.
struct Instant {
  const WheelScene& scene;
  Multibody s;
  bool slides;
  Vector2 d;       // direction of the slip, fixed axes
  Vector9 column;  // right-hand side
};

Instant instant_of(const WheelScene& scene, const double* y, bool slides) {
  Instant now = {scene, Multibody(scene.wheel, whole(scene.wheel, y, slides).data()), slides, {}, {}};
  now.column << F(now.s, scene.load), -now.s.B_dot * now.s.q_dot;
  now.column.segment<3>(3) += F_beta(now.s);
  if (!slides) return now;
  now.d = direction(y);
  now.column.segment<2>(6).setZero();
  // always: rates and the release agree on N
  now.column[8] -= decay_rate(now.s, scene.guided) * (now.s.B * now.s.q_dot)[2];
  return now;
}

// Matrix of (24), with [M] from (18). Where the wheel slides, lambda_1 + mu d_X lambda_3 = 0 and the same along Y stand
// in the place of the horizontal constraints.
Matrix9 system_matrix(const Instant& now, double kappa, double mu) {
  const Multibody& s = now.s;
  Matrix9 K = Matrix9::Zero();
  K.block<3, 3>(0, 0) = s.wheel.m * Matrix3::Identity();
  K.block<3, 3>(3, 3) = J(s.wheel) * s.Q;
  K.block<6, 3>(0, 6) = -B_tilde(s, kappa);
  K.block<3, 6>(6, 0) = s.B;
  if (!now.slides) return K;
  K.block<2, 9>(6, 0).setZero();
  K.block<2, 2>(6, 6).setIdentity();
  K.block<2, 1>(6, 8) = mu * now.d;
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
Solution solve(const Instant& now, bool pulls) {
  const Multibody& s = now.s;
  const double kappa = wheel_kappa(&now.scene.friction, s.omega_z), brake = now.scene.load.brake;
  Vector9 column = now.column;
  column[about_axle] -= brake * kappa;  // tau = -(s N + brake) kappa
  Matrix9 matrix = system_matrix(now, pulls ? 0 : kappa, pulls ? 0 : now.scene.mu_slide);
  if (now.scene.guided) guide(now.scene.load, matrix, column);
  const Eigen::PartialPivLU<Matrix9> K(matrix);
  const Vector9 unknowns = K.solve(column);
  if (now.scene.friction.kind == WHEEL_HELD) {  // tau is found from omega_z_dot = 0, linearly; kappa = 0
    const Vector9 unit = K.solve(Vector9::Unit(about_axle));
    const double compliance = s.Q.row(2).dot(unit.segment<3>(3)), tau = -omega_z_dot(s, unknowns) / compliance;
    return {unknowns + unit * tau, tau, now.slides ? K.determinant() * compliance : 0};
  }
  const double tau = kappa == 0 ? 0 : -((pulls ? 0 : s.wheel.s * unknowns[lambda_3]) + brake) * kappa;
  return {unknowns, tau, now.slides ? K.determinant() : 0};
}

// (24) under the scene's law of friction.
Solution solve(const Instant& now) {
  const WheelGround ground = now.scene.ground;
  if (ground == WHEEL_GROUND_PULLS) return solve(now, true);
  Solution presses = solve(now, false);
  if (ground == WHEEL_GROUND_PRESSES || (now.scene.friction.kind == WHEEL_HELD && !now.slides)) return presses;
  // sliding friction keeps its sign
  const double N = (now.slides ? solve(now, true) : presses).unknowns[lambda_3];
  return N <= 0 ? solve(now, true) : presses;
}

double spin_rate(const Instant& now, const Solution& solution) {
  return now.scene.friction.kind == WHEEL_HELD ? 0 : omega_z_dot(now.s, solution.unknowns);
}

template <bool slides>
void start(const WheelParameters* wheel, const WheelMotion* motion, double* y) {
  const double spin_start = motion->phi_dot + motion->psi_dot * std::cos(motion->theta);
  Eigen::Map<Vector6>(y) << motion->X_O, motion->Y_O, wheel_height(wheel, motion->theta), motion->psi, motion->theta,
      motion->phi;
  Eigen::Map<Vector3>(y + psi_dot) << motion->psi_dot, motion->theta_dot, spin_start;
  set_rolling_velocity(wheel, y);
  if (!slides) return;
  y[speed] = Vector2(motion->slip_x, motion->slip_y).norm();
  y[chi] = wheel_angle_of(motion->slip_x, motion->slip_y);
}

// (24) with -[B_dot]{q_dot} - decay_rate [B]{q_dot} in the last rows, and a height that decays to that of (32)
// (Baumgarte). Both added terms vanish on the constraints. The rate of the slip is that of [B]{q_dot}; its axes turn
// with psi. N is infinite where the wheel jams.
template <bool slides>
double derivative(const WheelScene* scene, const double* y, double* y_dot) {
  Instant now = instant_of(*scene, y, slides);
  const Multibody& s = now.s;
  const double rate = decay_rate(s, scene->guided);
  if (!slides) now.column.tail<3>() -= rate * (s.B * s.q_dot);
  const Solution solution = solve(now);
  const double N = solution.unknowns[lambda_3];
  Eigen::Map<Vector6> velocities(y_dot), accelerations(y_dot + 6);
  velocities = s.q_dot;
  velocities[Z_O] -= rate * (y[Z_O] - (scene->wheel.r_0 * s.attitude.sin_theta + scene->wheel.r));
  accelerations = solution.unknowns.head<6>();
  y_dot[spin] = spin_rate(now, solution);
  if (!slides) return N;
  const Vector3 slip_dot = s.B * solution.unknowns.head<6>() + s.B_dot * s.q_dot;
  const Vector2& d = now.d;
  y_dot[speed] = slip_dot.head<2>().dot(d);
  y_dot[chi] = y[speed] == 0 ? 0 : (slip_dot[1] * d[0] - slip_dot[0] * d[1]) / y[speed] - y[psi_dot];
  // Without friction the determinant is -sin(theta) times positive terms.
  const bool has_room = scene->guided || solution.determinant < 0;
  constexpr double usual = 100;  // weights
  if (has_room && N >= 0 && N < usual * scene->wheel.m * scene->wheel.g) return N;
  return solve(now, true).unknowns[lambda_3] / N < WHEEL_LEAST_ROOM ? INFINITY : N;
}

template <bool slides>
void kinematics(const WheelParameters* wheel, const double* state, WheelKinematics* out) {
  const States y = whole(*wheel, state, slides);
  const double phi_dot = y[spin] - y[psi_dot] * std::cos(y[theta]);
  *out = {y[X_O],     y[Y_O],     y[Z_O],     y[psi],       y[theta], y[phi], y[X_O_dot],
          y[Y_O_dot], y[Z_O_dot], y[psi_dot], y[theta_dot], phi_dot,  y[spin]};
}

template <bool slides>
void dynamics(const WheelScene* scene, const double* y, WheelDynamics* out) {
  const Instant now = instant_of(*scene, y, slides);
  const Solution solution = solve(now);
  const auto& [x, tau, determinant] = solution;
  *out = {x[X_O], x[Y_O], x[Z_O], x[psi], x[theta], x[phi], spin_rate(now, solution), {}, tau};
  std::copy_n(&x[lambda_1], 3, out->lambda);
}

template <bool slides>
void stop_spin(const WheelParameters* wheel, double* y) {
  y[spin] = 0;
  if (!slides) set_rolling_velocity(wheel, y);
}

template <bool slides>
void reduce(const double* y, double* reduced) {
  const WheelMotion motion = {y[psi], y[theta], y[phi], y[psi_dot], y[theta_dot], 0, y[X_O], y[Y_O], 0, 0};
  wheel_reduced.start(nullptr, &motion, reduced);  // reads no parameter
  reduced[WHEEL_OMEGA_3] = y[spin];
  if (!slides) return;
  reduced[WHEEL_SLIP] = y[speed];
  reduced[WHEEL_CHI] = y[chi];
}

template <bool slides>
constexpr WheelFormulation formulation = {
    .states = WHEEL_MULTIBODY_STATES,
    .start = start<slides>,
    .derivative = derivative<slides>,
    .spin_index = spin,
    .tilt_index = theta,
    .slip_index = slides ? int{speed} : -1,
    .kinematics = kinematics<slides>,
    .dynamics = dynamics<slides>,
    .reduce = reduce<slides>,
    .stop_spin = stop_spin<slides>,
    .grip = slides ? set_rolling_velocity : nullptr,
};

}  // namespace
}  // namespace wheel::paper

const WheelFormulation wheel_multibody = wheel::paper::formulation<false>;
const WheelFormulation wheel_multibody_sliding = wheel::paper::formulation<true>;
