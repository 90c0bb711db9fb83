// The paper's matrices, (1)-(13), line by line, as functions of the Euler angles and their rates. Eigen.
//
// Fixed axes for forces and O, body axes for rotation. Two misprints are mended here, marked with their name in
// docs/errata.md: U_theta (5) and Q_theta (9).
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "wheel_equations.h"

namespace wheel::paper {

using Matrix3 = Eigen::Matrix3d;
using Vector3 = Eigen::Vector3d;

// Euler angles beta = (psi, theta, phi) and their rates; trigonometry evaluated once.
struct Attitude {
  double psi, theta, phi;
  Vector3 beta_dot;
  double sin_psi = std::sin(psi), cos_psi = std::cos(psi);
  double sin_theta = std::sin(theta), cos_theta = std::cos(theta);
  double sin_phi = std::sin(phi), cos_phi = std::cos(phi);
};

// By rows.
inline Matrix3 matrix(const double (&rows)[3][3]) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(rows[0]);
}

// clang-format off: matrices stand as the paper prints them.

// (3): rotation about z by an angle of the given sine and cosine; [psi] and [phi].
inline Matrix3 rotation_z(double sine, double cosine) {
  return matrix({{cosine, -sine,   0},
                 {sine,    cosine, 0},
                 {0,       0,      1}});
}

// (3): [theta], rotation about x.
inline Matrix3 rotation_x(double sine, double cosine) {
  return matrix({{1, 0,       0},
                 {0, cosine, -sine},
                 {0, sine,    cosine}});
}

// (5): generator of rotations about z, [U_psi] = [U_phi].
inline Matrix3 U_z() {
  return matrix({{0, -1, 0},
                 {1,  0, 0},
                 {0,  0, 0}});
}

// (5), misprint U_theta mended: the 1 of row 3 stands in column 2.
inline Matrix3 U_theta() {
  return matrix({{0, 0,  0},
                 {0, 0, -1},
                 {0, 1,  0}});
}

// (4): [A] = [psi][theta][phi], body to fixed axes.
inline Matrix3 A(const Attitude& a) {
  return rotation_z(a.sin_psi, a.cos_psi) * rotation_x(a.sin_theta, a.cos_theta) * rotation_z(a.sin_phi, a.cos_phi);
}

// (6)
inline Matrix3 A_psi(const Matrix3& A) { return U_z() * A; }
inline Matrix3 A_theta(const Matrix3& A, const Attitude& a) {
  const Matrix3 phi = rotation_z(a.sin_phi, a.cos_phi);
  return A * phi.transpose() * U_theta() * phi;
}
inline Matrix3 A_phi(const Matrix3& A) { return A * U_z(); }

// (7)
inline Matrix3 A_dot(const Matrix3& A, const Attitude& a) {
  return a.beta_dot[0] * A_psi(A) + a.beta_dot[1] * A_theta(A, a) + a.beta_dot[2] * A_phi(A);
}

// (8): omega in body axes = [Q] beta_dot.
inline Matrix3 Q(const Attitude& a) {
  return matrix({{a.sin_theta * a.sin_phi,  a.cos_phi, 0},
                 {a.sin_theta * a.cos_phi, -a.sin_phi, 0},
                 {a.cos_theta,              0,         1}});
}

// (9), misprint Q_theta mended: row 3 is -sin(theta) 0 0.
inline Matrix3 Q_theta(const Attitude& a) {
  return matrix({{ a.cos_theta * a.sin_phi, 0, 0},
                 { a.cos_theta * a.cos_phi, 0, 0},
                 {-a.sin_theta,             0, 0}});
}
inline Matrix3 Q_phi(const Attitude& a) {
  return matrix({{ a.sin_theta * a.cos_phi, -a.sin_phi, 0},
                 {-a.sin_theta * a.sin_phi, -a.cos_phi, 0},
                 { 0,                        0,         0}});
}

// (10)
inline Matrix3 Q_dot(const Attitude& a) { return a.beta_dot[1] * Q_theta(a) + a.beta_dot[2] * Q_phi(a); }

// (11): cross-product matrix of the vector from O to the contact, body axes.
inline Matrix3 r(const WheelParameters& w, const Attitude& a) {
  const double eta = w.r * a.cos_theta, rho = w.r_0 + w.r * a.sin_theta;
  return matrix({{ 0,                eta,             -rho * a.cos_phi},
                 {-eta,              0,                rho * a.sin_phi},
                 { rho * a.cos_phi, -rho * a.sin_phi,  0}});
}

// (12)
inline Matrix3 r_theta(const WheelParameters& w, const Attitude& a) {
  const double s = w.r * a.sin_theta, c = w.r * a.cos_theta;
  return matrix({{0,             -s,             -c * a.cos_phi},
                 {s,              0,              c * a.sin_phi},
                 {c * a.cos_phi, -c * a.sin_phi,  0}});
}
inline Matrix3 r_phi(const WheelParameters& w, const Attitude& a) {
  const double rho = w.r_0 + w.r * a.sin_theta;
  return matrix({{ 0,                0,               rho * a.sin_phi},
                 { 0,                0,               rho * a.cos_phi},
                 {-rho * a.sin_phi, -rho * a.cos_phi, 0}});
}

// (13)
inline Matrix3 r_dot(const WheelParameters& w, const Attitude& a) {
  return a.beta_dot[1] * r_theta(w, a) + a.beta_dot[2] * r_phi(w, a);
}

// (2)
inline Matrix3 J(const WheelParameters& w) { return Vector3(w.J_x, w.J_y, w.J_z).asDiagonal(); }

// clang-format on

}  // namespace wheel::paper
