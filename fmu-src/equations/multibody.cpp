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

// The ground's friction against a slip: mu_slide along the direction of the slip, fixed axes. Zero where it pulls.
using Against = Eigen::Vector2d;

// Matrix of (24), with [M] from (18). `slides`: lambda_1 + mu d_X lambda_3 = 0 and the same along Y stand in the place
// of the horizontal constraints.
Matrix9 system_matrix(const Multibody& s, double kappa, const Against* slides = nullptr) {
  Matrix9 K = Matrix9::Zero();
  K.block<3, 3>(0, 0) = s.wheel.m * Matrix3::Identity();
  K.block<3, 3>(3, 3) = J(s.wheel) * s.Q;
  K.block<6, 3>(0, 6) = -B_tilde(s, kappa);
  K.block<3, 6>(6, 0) = B(s);
  if (!slides) return K;
  K.block<2, 9>(6, 0).setZero();
  K.block<2, 2>(6, 6).setIdentity();
  K.block<2, 1>(6, 8) = *slides;
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
Solution solve_held(const Multibody& s, const Vector9& column, const Against* slides) {
  const Eigen::PartialPivLU<Matrix9> K(system_matrix(s, 0, slides));
  const Vector9 free = K.solve(column), unit = K.solve(Vector9::Unit(about_axle));
  const double tau = -omega_z_dot(s, free) / s.Q.row(2).dot(unit.segment<3>(3));
  return {free + unit * tau, tau};
}

// The moment -(s N + brake) kappa about the axle.
Solution solve_rolling(const WheelScene& scene, const Multibody& s, Vector9 column, bool pulls, const Against* slides) {
  const double kappa = wheel_kappa(&scene.friction, omega_z(s)), brake = scene.load.brake;
  column[about_axle] -= brake * kappa;
  const Vector9 unknowns = system_matrix(s, pulls ? 0 : kappa, slides).partialPivLu().solve(column);
  if (kappa == 0) return {unknowns, 0};
  return {unknowns, -((pulls ? 0 : s.wheel.s * unknowns[lambda_3]) + brake) * kappa};
}

// (24) under the scene's law of friction. A ground that pulls has no friction: only the brake's part is left.
Solution solve(const WheelScene& scene, const Multibody& s, const Vector9& column, const Against* slides = nullptr) {
  const bool held = scene.friction.kind == WHEEL_HELD;
  const Against none = Against::Zero();
  const auto by_law = [&](bool pulls) {
    const Against* const against = slides && pulls ? &none : slides;
    return held ? solve_held(s, column, against) : solve_rolling(scene, s, column, pulls, against);
  };
  if (scene.ground == WHEEL_GROUND_PULLS) return by_law(true);
  Solution presses = by_law(false);
  if (scene.ground == WHEEL_GROUND_PRESSES || (held && !slides)) return presses;
  const bool pulls = (slides ? by_law(true) : presses).unknowns[lambda_3] <= 0;  // sliding friction keeps the sign of N
  return pulls ? by_law(true) : presses;
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

void fill_dynamics(const WheelScene& scene, const Multibody& s, const Solution& solution, WheelDynamics* out) {
  const auto& [x, tau] = solution;
  const double spin_dot = scene.friction.kind == WHEEL_HELD ? 0 : omega_z_dot(s, x);
  *out = {x[X_O], x[Y_O], x[Z_O], x[psi], x[theta], x[phi], spin_dot, {x[lambda_1], x[lambda_2], x[lambda_3]}, tau};
}

void dynamics(const WheelScene* scene, const double* y, WheelDynamics* out) {
  const Multibody s(scene->wheel, y);
  fill_dynamics(*scene, s, solve(*scene, s, system_column(s, scene->load)), out);
}

void stop_spin(const WheelParameters* wheel, double* y) {
  y[spin] = 0;
  set_rolling_velocity(*wheel, y);
}

void reduce(const double* y, double* reduced) {
  Eigen::Map<Eigen::Vector<double, WHEEL_REDUCED_STATES>>(reduced) << y[theta], y[theta_dot],
      y[psi_dot] * std::sin(y[theta]), y[spin], y[psi], y[phi], y[X_O], y[Y_O];
}

// The wheel that slides: |u| and chi are states in the place of X_O_dot and Y_O_dot.
enum SlipState { speed = X_O_dot, chi = Y_O_dot };

Eigen::Vector2d slip_direction(const double* y) { return {std::cos(y[psi] + y[chi]), std::sin(y[psi] + y[chi])}; }

using States = std::array<double, WHEEL_MULTIBODY_STATES>;

// The multibody state of a sliding one: (19) with the slip on its right-hand side, but for Z_O_dot, which is a state.
States released(const WheelParameters& wheel, const double* sliding) {
  States y;
  std::copy_n(sliding, y.size(), y.data());
  set_rolling_velocity(wheel, y.data());
  Eigen::Map<Eigen::Vector2d>(y.data() + X_O_dot) += sliding[speed] * slip_direction(sliding);
  y[Z_O_dot] = sliding[Z_O_dot];
  return y;
}

struct Sliding {
  States y;
  Multibody s;
  Against slides;
  Vector9 column;

  Sliding(const WheelScene& scene, const double* sliding)
      : y(released(scene.wheel, sliding)),
        s(scene.wheel, y.data()),
        slides(scene.mu_slide * slip_direction(sliding)),
        column(system_column(s, scene.load)) {
    column.segment<2>(6).setZero();
    column[8] -= decay_rate(s) * (B(s) * s.q_dot)[2];  // in `dynamics` too: rates and the release agree on N
  }
};

// As `derivative`, with the two rows that are left; the slip's rate is that of [B]{q_dot}, its axes turn with psi.
double sliding_derivative(const WheelScene* scene, const double* y, double* y_dot) {
  const Sliding now(*scene, y);
  const Multibody& s = now.s;
  const Solution solution = solve(*scene, s, now.column, &now.slides);
  Eigen::Map<Vector6> velocities(y_dot), accelerations(y_dot + 6);
  const Vector3 slip_dot = B(s) * solution.unknowns.head<6>() + B_dot(s) * s.q_dot;
  const Eigen::Vector2d d = slip_direction(y);
  velocities = s.q_dot;
  velocities[Z_O] -= decay_rate(s) * (y[Z_O] - (scene->wheel.r_0 * s.attitude.sin_theta + scene->wheel.r));
  accelerations = solution.unknowns.head<6>();
  y_dot[speed] = slip_dot.head<2>().dot(d);
  y_dot[chi] = y[speed] == 0 ? 0 : (slip_dot[1] * d[0] - slip_dot[0] * d[1]) / y[speed] - y[psi_dot];
  y_dot[spin] = scene->friction.kind == WHEEL_HELD ? 0 : omega_z_dot(s, solution.unknowns);
  const double N = solution.unknowns[lambda_3];
  constexpr double usual = 100;  // weights
  if (N >= 0 && N < usual * scene->wheel.m * scene->wheel.g) return N;
  const Against none = Against::Zero();
  return solve(*scene, s, now.column, &none).unknowns[lambda_3] / N < WHEEL_LEAST_ROOM ? INFINITY : N;
}

void sliding_start(const WheelParameters* wheel, const WheelMotion* motion, double* y) {
  start(wheel, motion, y);
  y[speed] = Eigen::Vector2d(motion->slip_x, motion->slip_y).norm();
  y[chi] = wheel_angle_of(motion->slip_x, motion->slip_y);
}

void sliding_kinematics(const WheelParameters* wheel, const double* y, WheelKinematics* out) {
  kinematics(wheel, released(*wheel, y).data(), out);
}

void sliding_dynamics(const WheelScene* scene, const double* y, WheelDynamics* out) {
  const Sliding now(*scene, y);
  fill_dynamics(*scene, now.s, solve(*scene, now.s, now.column, &now.slides), out);
}

void sliding_stop_spin(const WheelParameters*, double* y) { y[spin] = 0; }

void sliding_grip(const WheelParameters* wheel, double* y) { set_rolling_velocity(*wheel, y); }

void sliding_reduce(const double* y, double* reduced) {
  std::fill_n(reduced, WHEEL_SLIDING_STATES, 0.0);
  reduce(y, reduced);
  std::copy_n(y + speed, 2, reduced + WHEEL_REDUCED_STATES);
}

}  // namespace
}  // namespace wheel::paper

using namespace wheel::paper;

// Its velocities are states: the pose takes no more than they do.
const WheelFormulation wheel_multibody = {"multibody", WHEEL_MULTIBODY_STATES,
                                          start,       derivative,
                                          spin,        theta,
                                          -1,          kinematics,
                                          kinematics,  dynamics,
                                          reduce,      stop_spin,
                                          nullptr};

const WheelFormulation wheel_multibody_sliding = {"multibody_sliding",
                                                  WHEEL_MULTIBODY_STATES,
                                                  sliding_start,
                                                  sliding_derivative,
                                                  spin,
                                                  theta,
                                                  speed,
                                                  sliding_kinematics,
                                                  sliding_kinematics,
                                                  sliding_dynamics,
                                                  sliding_reduce,
                                                  sliding_stop_spin,
                                                  sliding_grip};
