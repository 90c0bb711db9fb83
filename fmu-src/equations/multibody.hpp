// The paper's system of equations of motion, (15)-(24), any inertia. Eigen.
//
// Unknowns q_ddot (6) and lambda (3); rows: motion of O (fixed axes), rotation (body axes), constraint [B]{q_ddot} =
// -[B_dot]{q_dot}. Mended misprints, see docs/errata.md: the sign and the bracket of F_beta (16), q_ddot in (24).
#pragma once

#include <Eigen/LU>
#include <cmath>

#include "paper_matrices.hpp"

namespace wheel::paper {

template <class T>
using Matrix9 = Eigen::Matrix<T, 9, 9>;
template <class T>
using Vector9 = Eigen::Matrix<T, 9, 1>;
template <class T>
using Matrix36 = Eigen::Matrix<T, 3, 6>;
template <class T>
using Vector6 = Eigen::Matrix<T, 6, 1>;

// A state y = (q, q_dot; omega_z in the place of phi_dot) with the matrices that (16)-(24) share.
template <class T>
struct Multibody {
  const WheelParameters& wheel;
  Attitude<T> attitude;
  Vector6<T> q_dot;
  Matrix3<T> A, A_dot, Q, Q_dot, r, r_dot;

  template <class Vector>
  Multibody(const WheelParameters& w, const Vector& y)
      : wheel(w), attitude(y[3], y[4], y[5], Vector3<T>(y[9], y[10], T(0))) {
    attitude.beta_dot[2] = y[11] - y[9] * attitude.cos_theta;
    for (int i = 0; i < 3; ++i) q_dot[i] = y[6 + i];
    q_dot.template tail<3>() = attitude.beta_dot;
    A = paper::A(attitude);
    A_dot = paper::A_dot(A, attitude);
    Q = paper::Q(attitude);
    Q_dot = paper::Q_dot(attitude);
    r = paper::r(w, attitude);
    r_dot = paper::r_dot(w, attitude);
  }
};

// (19): [B] = [[I] [A][r]^T[Q]]; [B]{q_dot} is the velocity of the wheel's material point at the contact.
template <class T>
Matrix36<T> B(const Multibody<T>& s) {
  Matrix36<T> B;
  B << Matrix3<T>::Identity(), s.A * s.r.transpose() * s.Q;
  return B;
}

// (20)
template <class T>
Matrix36<T> B_dot(const Multibody<T>& s) {
  Matrix36<T> B_dot;
  B_dot << Matrix3<T>::Zero(),
      s.A_dot * s.r.transpose() * s.Q + s.A * s.r_dot.transpose() * s.Q + s.A * s.r.transpose() * s.Q_dot;
  return B_dot;
}

// (21): omega_z = [0 0 1][Q]{beta_dot}
template <class T>
T omega_z(const Multibody<T>& s) {
  return s.Q.row(2).dot(s.attitude.beta_dot);
}

// (22): the moment -s N kappa about the axle as a matrix on lambda. The third component of lambda in body axes is not
// N, so [B*] acts on lambda in fixed axes: row z, column Z.
template <class T>
Matrix3<T> B_star(const WheelParameters& w, const T& kappa) {
  Matrix3<T> B_star = Matrix3<T>::Zero();
  B_star(2, 2) = -w.s * kappa;
  return B_star;
}

// (23): how lambda enters the equations of motion.
template <class T>
Eigen::Matrix<T, 6, 3> B_tilde(const Multibody<T>& s, const T& kappa) {
  Eigen::Matrix<T, 6, 3> B_tilde;
  B_tilde << Matrix3<T>::Identity(), s.r * s.A.transpose() + B_star<T>(s.wheel, kappa);
  return B_tilde;
}

// (15), generalised: weight, F at O (fixed axes), M turned from the carrier into body axes by [phi]^T.
template <class T>
Vector6<T> F(const Multibody<T>& s, const Vector3<T>& force, const Vector3<T>& moment) {
  Vector6<T> F;
  F << force, rotation_z<T>(s.attitude.sin_phi, s.attitude.cos_phi).transpose() * moment;
  F[2] -= T(s.wheel.m * s.wheel.g);
  return F;
}

// (16), misprint F_beta mended: -([J][Q_dot] + [A]^T[A_dot][J][Q]){beta_dot}.
template <class T>
Vector3<T> F_beta(const Multibody<T>& s) {
  const Matrix3<T> inertia = J<T>(s.wheel);
  return -(inertia * s.Q_dot + s.A.transpose() * s.A_dot * inertia * s.Q) * s.attitude.beta_dot;
}

// Matrix of (24), with [M] from (18).
template <class T>
Matrix9<T> system_matrix(const Multibody<T>& s, const T& kappa) {
  Matrix9<T> K = Matrix9<T>::Zero();
  K.template block<3, 3>(0, 0) = Matrix3<T>::Identity() * T(s.wheel.m);
  K.template block<3, 3>(3, 3) = J<T>(s.wheel) * s.Q;
  K.template block<6, 3>(0, 6) = -B_tilde<T>(s, kappa);
  K.template block<3, 6>(6, 0) = B<T>(s);
  return K;
}

// Right-hand side of (24).
template <class T>
Vector9<T> system_column(const Multibody<T>& s, const Vector3<T>& force, const Vector3<T>& moment) {
  Vector9<T> column;
  column.template head<6>() = F<T>(s, force, moment);
  column.template segment<3>(3) += F_beta<T>(s);
  column.template tail<3>() = -B_dot<T>(s) * s.q_dot;
  return column;
}

// Solution of (24) and the ground's moment about the axle.
template <class T>
struct Solution {
  Vector9<T> unknowns;  // q_ddot, lambda
  T tau;
};

// omega_z_dot from q_ddot: derivative of (21).
template <class T>
T omega_z_dot(const Multibody<T>& s, const Vector9<T>& unknowns) {
  return s.Q.row(2).dot(unknowns.template segment<3>(3)) + s.Q_dot.row(2).dot(s.attitude.beta_dot);
}

// Linear systems with one matrix. Numbers that carry a derivative have a specialisation of their own (rates.cpp):
// Eigen's triangular solver skips entries whose value is zero, and their derivative with them.
template <class T>
class Factors {
 public:
  explicit Factors(const Matrix9<T>& K) : lu_(K) {}
  Vector9<T> solve(const Vector9<T>& column) const { return lu_.solve(column); }

 private:
  Eigen::PartialPivLU<Matrix9<T>> lu_;
};

// (24) with omega_z held: the moment tau about the axle is found from omega_z_dot = 0, linearly.
template <class T>
Solution<T> solve_held(const Multibody<T>& s, const Vector9<T>& column) {
  const Factors<T> factors(system_matrix<T>(s, T(0)));
  Vector9<T> about_axle = Vector9<T>::Zero();
  about_axle[5] = T(1);
  const Vector9<T> free = factors.solve(column), unit = factors.solve(about_axle);
  const T per_tau = s.Q.row(2).dot(unit.template segment<3>(3));
  const T tau = -omega_z_dot<T>(s, free) / per_tau;
  return {free + unit * tau, tau};
}

// (24) with the moment -s N kappa about the axle; without pressure (N <= 0) there is no friction.
template <class T>
Solution<T> solve_rolling(const Multibody<T>& s, const Vector9<T>& column, const T& kappa) {
  const Vector9<T> unknowns = Factors<T>(system_matrix<T>(s, kappa)).solve(column);
  if (kappa == T(0)) return {unknowns, T(0)};
  if (unknowns[8] > T(0)) return {unknowns, -s.wheel.s * kappa * unknowns[8]};
  return {Factors<T>(system_matrix<T>(s, T(0))).solve(column), T(0)};
}

// (24) with the friction law of the scene.
template <class T>
Solution<T> solve(const WheelFriction& friction, const Multibody<T>& s, const Vector9<T>& column) {
  using std::tanh;
  switch (friction.kind) {
    case WHEEL_HELD:
      return solve_held<T>(s, column);
    case WHEEL_ROLLING:
      return solve_rolling<T>(s, column, T(friction.sigma));
    case WHEEL_REGULARIZED:
      return solve_rolling<T>(s, column, T(tanh(omega_z<T>(s) / friction.omega_s)));
    case WHEEL_FRICTIONLESS:
      break;
  }
  return solve_rolling<T>(s, column, T(0));
}

// Rate at which errors of the constraints decay, 1/s: some times the rates of the motion itself, so that it is never
// the stiffest part.
template <class T>
T decay_rate(const Multibody<T>& s) {
  using std::sqrt;
  const T omega_squared = (s.Q * s.attitude.beta_dot).squaredNorm();
  return 5.0 * sqrt(s.wheel.g / (s.wheel.r_0 + s.wheel.r) + omega_squared);
}

// (24) with -[B_dot]{q_dot} - a [B]{q_dot} in the last rows, and the height drawn to that of (32) (Baumgarte): both
// terms vanish on the constraints. Returns N.
template <class T>
T state_rate(const WheelScene& scene, const Vector3<T>& force, const Vector3<T>& moment, const T* y, T* y_dot) {
  const Multibody<T> s(scene.wheel, y);
  const T rate = decay_rate<T>(s);
  Vector9<T> column = system_column<T>(s, force, moment);
  column.template tail<3>() -= rate * (B<T>(s) * s.q_dot);
  const Solution<T> solution = solve<T>(scene.friction, s, column);
  for (int i = 0; i < 6; ++i) y_dot[i] = s.q_dot[i];
  y_dot[2] -= rate * (y[2] - (scene.wheel.r_0 * s.attitude.sin_theta + scene.wheel.r));
  for (int i = 0; i < 5; ++i) y_dot[6 + i] = solution.unknowns[i];
  y_dot[11] = scene.friction.kind == WHEEL_HELD ? T(0) : omega_z_dot<T>(s, solution.unknowns);
  return solution.unknowns[8];
}

}  // namespace wheel::paper
