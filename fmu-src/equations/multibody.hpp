// The paper's system of equations of motion, (15)-(24), any inertia. Eigen.
//
// Unknowns q_ddot (6) and lambda (3); rows: motion of O (fixed axes), rotation (body axes), constraint [B]{q_ddot} =
// -[B_dot]{q_dot}. Mended misprints, see docs/errata.md: the sign and the bracket of F_beta (16), q_ddot in (24).
#pragma once

#include <Eigen/Core>

#include "paper_matrices.hpp"

namespace wheel::paper {

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
  Matrix3 A, A_dot, Q, Q_dot, r, r_dot;

  Multibody(const WheelParameters& w, const double* y)
      : wheel(w),
        attitude{y[psi], y[theta], y[phi], {y[psi_dot], y[theta_dot], y[spin] - y[psi_dot] * std::cos(y[theta])}} {
    q_dot << y[X_O_dot], y[Y_O_dot], y[Z_O_dot], attitude.beta_dot;
    A = paper::A(attitude);
    A_dot = paper::A_dot(A, attitude);
    Q = paper::Q(attitude);
    Q_dot = paper::Q_dot(attitude);
    r = paper::r(w, attitude);
    r_dot = paper::r_dot(w, attitude);
  }
};

// (19): [B] = [[I] [A][r]^T[Q]]; [B]{q_dot} is the velocity of the wheel's material point at the contact.
inline Matrix36 B(const Multibody& s) {
  Matrix36 B;
  B << Matrix3::Identity(), s.A * s.r.transpose() * s.Q;
  return B;
}

// (20)
inline Matrix36 B_dot(const Multibody& s) {
  Matrix36 B_dot;
  B_dot << Matrix3::Zero(),
      s.A_dot * s.r.transpose() * s.Q + s.A * s.r_dot.transpose() * s.Q + s.A * s.r.transpose() * s.Q_dot;
  return B_dot;
}

// (21): omega_z = [0 0 1][Q]{beta_dot}, and its derivative from the unknowns of (24).
inline double omega_z(const Multibody& s) { return s.Q.row(2).dot(s.attitude.beta_dot); }
inline double omega_z_dot(const Multibody& s, const Vector9& unknowns) {
  return s.Q.row(2).dot(unknowns.segment<3>(3)) + s.Q_dot.row(2).dot(s.attitude.beta_dot);
}

// (22): the moment -s N kappa about the axle as a matrix on lambda. The third component of lambda in body axes is not
// N, so [B*] acts on lambda in fixed axes: row z, column Z.
inline Matrix3 B_star(const WheelParameters& w, double kappa) { return Vector3(0, 0, -w.s * kappa).asDiagonal(); }

// (23): how lambda enters the equations of motion.
inline Matrix63 B_tilde(const Multibody& s, double kappa) {
  Matrix63 B_tilde;
  B_tilde << Matrix3::Identity(), s.r * s.A.transpose() + B_star(s.wheel, kappa);
  return B_tilde;
}

// (15), generalised: weight (tilted on a slope), F at O (fixed axes), M turned from the carrier into body axes by
// [phi]^T.
inline Vector6 F(const Multibody& s, const WheelLoad& load) {
  const Matrix3 phi = rotation_z(s.attitude.sin_phi, s.attitude.cos_phi);
  Vector6 F;
  F << Vector3(load.F) + s.wheel.m * Vector3(s.wheel.g_X, s.wheel.g_Y, -s.wheel.g), phi.transpose() * Vector3(load.M);
  return F;
}

// (16), misprint F_beta mended: -([J][Q_dot] + [A]^T[A_dot][J][Q]){beta_dot}.
inline Vector3 F_beta(const Multibody& s) {
  const Matrix3 inertia = J(s.wheel);
  return -(inertia * s.Q_dot + s.A.transpose() * s.A_dot * inertia * s.Q) * s.attitude.beta_dot;
}

// Matrix of (24), with [M] from (18).
inline Matrix9 system_matrix(const Multibody& s, double kappa) {
  Matrix9 K = Matrix9::Zero();
  K.block<3, 3>(0, 0) = s.wheel.m * Matrix3::Identity();
  K.block<3, 3>(3, 3) = J(s.wheel) * s.Q;
  K.block<6, 3>(0, 6) = -B_tilde(s, kappa);
  K.block<3, 6>(6, 0) = B(s);
  return K;
}

// Right-hand side of (24).
inline Vector9 system_column(const Multibody& s, const WheelLoad& load) {
  Vector9 column;
  column << F(s, load), -B_dot(s) * s.q_dot;
  column.segment<3>(3) += F_beta(s);
  return column;
}

}  // namespace wheel::paper
