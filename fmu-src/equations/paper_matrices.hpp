// The paper's matrices, (1)-(23), line by line, as functions of the Euler angles and their rates. Eigen.
//
// Fixed axes for forces and O, body axes for rotation. Two misprints are mended here, marked with their name in
// docs/errata.md: U_theta (5) and Q_theta (9). T is double, or an automatic-differentiation scalar.
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "wheel_equations.h"

namespace wheel::paper {

template <class T>
using Matrix3 = Eigen::Matrix<T, 3, 3>;
template <class T>
using Vector3 = Eigen::Matrix<T, 3, 1>;

// Euler angles beta = (psi, theta, phi) and their rates; trigonometry evaluated once.
template <class T>
struct Attitude {
  T sin_psi, cos_psi, sin_theta, cos_theta, sin_phi, cos_phi;
  Vector3<T> beta_dot;

  Attitude(const T& psi, const T& theta, const T& phi, const Vector3<T>& rates) : beta_dot(rates) {
    using std::cos, std::sin;
    sin_psi = sin(psi), cos_psi = cos(psi);
    sin_theta = sin(theta), cos_theta = cos(theta);
    sin_phi = sin(phi), cos_phi = cos(phi);
  }
};

template <class T>
Matrix3<T> rows(const T& a, const T& b, const T& c, const T& d, const T& e, const T& f, const T& g, const T& h,
                const T& i) {
  Matrix3<T> matrix;
  matrix << a, b, c, d, e, f, g, h, i;
  return matrix;
}

// (3): rotation about z by an angle of the given sine and cosine; [psi] and [phi].
template <class T>
Matrix3<T> rotation_z(const T& s, const T& c) {
  const T o(0), l(1);
  return rows<T>(c, -s, o, s, c, o, o, o, l);
}

// (3): [theta], rotation about x.
template <class T>
Matrix3<T> rotation_x(const T& s, const T& c) {
  const T o(0), l(1);
  return rows<T>(l, o, o, o, c, -s, o, s, c);
}

// (5): generator of rotations about z, [U_psi] = [U_phi].
template <class T>
Matrix3<T> U_z() {
  const T o(0), l(1);
  return rows<T>(o, -l, o, l, o, o, o, o, o);
}

// (5), misprint U_theta mended: the 1 of row 3 stands in column 2.
template <class T>
Matrix3<T> U_theta() {
  const T o(0), l(1);
  return rows<T>(o, o, o, o, o, -l, o, l, o);
}

// (4): [A] = [psi][theta][phi], body to fixed axes.
template <class T>
Matrix3<T> A(const Attitude<T>& a) {
  return rotation_z<T>(a.sin_psi, a.cos_psi) * rotation_x<T>(a.sin_theta, a.cos_theta) *
         rotation_z<T>(a.sin_phi, a.cos_phi);
}

// (6)
template <class T>
Matrix3<T> A_psi(const Matrix3<T>& A) {
  return U_z<T>() * A;
}
template <class T>
Matrix3<T> A_theta(const Matrix3<T>& A, const Attitude<T>& a) {
  const Matrix3<T> phi = rotation_z<T>(a.sin_phi, a.cos_phi);
  return A * phi.transpose() * U_theta<T>() * phi;
}
template <class T>
Matrix3<T> A_phi(const Matrix3<T>& A) {
  return A * U_z<T>();
}

// (7)
template <class T>
Matrix3<T> A_dot(const Matrix3<T>& A, const Attitude<T>& a) {
  return a.beta_dot[0] * A_psi<T>(A) + a.beta_dot[1] * A_theta<T>(A, a) + a.beta_dot[2] * A_phi<T>(A);
}

// (8): omega in body axes = [Q] beta_dot.
template <class T>
Matrix3<T> Q(const Attitude<T>& a) {
  const T o(0), l(1);
  return rows<T>(a.sin_theta * a.sin_phi, a.cos_phi, o, a.sin_theta * a.cos_phi, -a.sin_phi, o, a.cos_theta, o, l);
}

// (9), misprint Q_theta mended: row 3 is -sin(theta) 0 0.
template <class T>
Matrix3<T> Q_theta(const Attitude<T>& a) {
  const T o(0);
  return rows<T>(a.cos_theta * a.sin_phi, o, o, a.cos_theta * a.cos_phi, o, o, -a.sin_theta, o, o);
}
template <class T>
Matrix3<T> Q_phi(const Attitude<T>& a) {
  const T o(0);
  return rows<T>(a.sin_theta * a.cos_phi, -a.sin_phi, o, -a.sin_theta * a.sin_phi, -a.cos_phi, o, o, o, o);
}

// (10)
template <class T>
Matrix3<T> Q_dot(const Attitude<T>& a) {
  return a.beta_dot[1] * Q_theta<T>(a) + a.beta_dot[2] * Q_phi<T>(a);
}

// (11): cross-product matrix of the vector from O to the contact, body axes.
template <class T>
Matrix3<T> r(const WheelParameters& w, const Attitude<T>& a) {
  const T o(0), eta = w.r * a.cos_theta, rho = w.r_0 + w.r * a.sin_theta;
  return rows<T>(o, eta, -rho * a.cos_phi, -eta, o, rho * a.sin_phi, rho * a.cos_phi, -rho * a.sin_phi, o);
}

// (12)
template <class T>
Matrix3<T> r_theta(const WheelParameters& w, const Attitude<T>& a) {
  const T o(0), s = w.r * a.sin_theta, c = w.r * a.cos_theta;
  return rows<T>(o, -s, -c * a.cos_phi, s, o, c * a.sin_phi, c * a.cos_phi, -c * a.sin_phi, o);
}
template <class T>
Matrix3<T> r_phi(const WheelParameters& w, const Attitude<T>& a) {
  const T o(0), rho = w.r_0 + w.r * a.sin_theta;
  return rows<T>(o, o, rho * a.sin_phi, o, o, rho * a.cos_phi, -rho * a.sin_phi, -rho * a.cos_phi, o);
}

// (13)
template <class T>
Matrix3<T> r_dot(const WheelParameters& w, const Attitude<T>& a) {
  return a.beta_dot[1] * r_theta<T>(w, a) + a.beta_dot[2] * r_phi<T>(w, a);
}

// (2)
template <class T>
Matrix3<T> J(const WheelParameters& w) {
  return Vector3<T>(T(w.J_x), T(w.J_y), T(w.J_z)).asDiagonal();
}

}  // namespace wheel::paper
