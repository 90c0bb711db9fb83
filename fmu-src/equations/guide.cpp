// A jump of the rates at which a wheel carrier turns the wheel: the limit of ever steeper ramps. Of a ramp in which
// omega_1 and omega_2 change by d_1 and d_2, over a part of it from 0 to 1 and in the symbols of sliding.c:
//   rolls   (J_z + m rho^2) omega_3_dot = m rho eta d_2 + tau
//   slides  J_z omega_3_dot = rho f_x + tau,  u_x_dot = f_x / m - eta d_2 + rho omega_3_dot,  u_y_dot = f_y / m + h d_1
// with |tau| <= s N, f = -mu_slide N u / |u| and N = m l d_1. Where N is negative, the ramp relieves the ground:
// friction of the weight that it takes away gives back to a spin, but drives no wheel that stands. Brake and weight are
// too weak for so steep a ramp. But a jump stands for a ramp as long as a communication step, and a wheel at rest that
// they would hold over one of a millisecond stays at rest: held, or in the layer of a regularized law so narrow that
// they stop any spin in it within the ramp.
#include <Eigen/LU>
#include <cmath>
#include <utility>

#include "constant.hpp"
#include "wheel_equations.h"

namespace {

using Vector = Eigen::Vector3d;  // u_x, u_y, omega_3
using Matrix = Eigen::Matrix3d;

CONSTANT(double, ramp, 1e-3, "s", "a held wheel that would be held over so long a ramp stays held");
CONSTANT(double, exactness, 1e-12, "of the largest speed", "error of a step along a ramp");
CONSTANT(double, narrow, 1e-13, "of the largest speed", "width of a law that has none: a smaller speed is zero");

struct Ramp {
  double m, J, rho;             // kg, kg m2 about the axle, m
  double a_x, a_y;              // m/s, changes of the slip without friction
  double free;                  // rad/s, change of omega_3 of a wheel that rolls, without friction
  double mu_N, s_N;             // N s, N m s, impulses of friction; below zero where the ramp relieves the ground
  double kappa;                 // of the spin at the start; acts where the ramp relieves the ground
  double width_u, width_omega;  // m/s, rad/s, below which friction falls to zero
  bool slides;
};

// (place) => its rates along the ramp, by its entries. Held: omega_3 stays.
Vector rates_of(const Ramp& r, const Vector& y, bool held, Matrix& slopes) {
  slopes.setZero();
  const bool relieves = r.s_N < 0;
  const double part = std::tanh(y[2] / r.width_omega), given = r.kappa * y[2] > 0 ? r.kappa : 0;
  const double kappa = relieves ? given : part;
  const double by_spin = held || relieves ? 0 : -r.s_N / r.J * (1 - part * part) / r.width_omega;
  if (!r.slides) {
    slopes(2, 2) = by_spin;
    return {0, 0, r.free - r.s_N / r.J * kappa};
  }
  const double q = std::sqrt(y[0] * y[0] + y[1] * y[1] + r.width_u * r.width_u);
  const double d_x = y[0] / q, d_y = y[1] / q, f_x = -r.mu_N * d_x, f_y = -r.mu_N * d_y;
  const double omega_dot = held ? 0 : (r.rho * f_x - r.s_N * kappa) / r.J, per_spin = held ? 0 : 1 / r.J;
  const double f_xx = -r.mu_N * (1 - d_x * d_x) / q, f_xy = r.mu_N * d_x * d_y / q,
               f_yy = -r.mu_N * (1 - d_y * d_y) / q;
  slopes.row(2) << r.rho * f_xx * per_spin, r.rho * f_xy * per_spin, by_spin;
  slopes.row(0) << f_xx / r.m, f_xy / r.m, 0;
  slopes.row(0) += r.rho * slopes.row(2);
  slopes.row(1) << f_xy / r.m, f_yy / r.m, 0;
  return {f_x / r.m + r.a_x + r.rho * omega_dot, f_y / r.m + r.a_y, omega_dot};
}

// N m s, the moment of friction that turns a sliding wheel.
double turning(const Ramp& r, const Vector& y) {
  return -r.rho * r.mu_N * y[0] / std::sqrt(y[0] * y[0] + y[1] * y[1] + r.width_u * r.width_u);
}

// (y, part h of the ramp) => y behind it, and the order at which the error fell below `exactness`; 0: it did not.
// Linearly implicit Euler steps, extrapolated: friction that holds a speed at zero is stiff. Friction below zero drives
// a slip away from there, and explicit steps follow it.
int step(const Ramp& r, double h, bool held, double scale, Vector& y) {
  constexpr int orders = 9;
  Matrix slopes, unused;
  rates_of(r, y, held, slopes);
  if (r.mu_N < 0) slopes.setZero();
  Vector table[orders];
  for (int n = 1; n <= orders; ++n) {
    const double part = h / n;
    const Matrix inverse = (Matrix::Identity() - part * slopes).inverse();
    Vector next = y;
    for (int i = 0; i < n; ++i) next += inverse * (part * rates_of(r, next, held, unused));
    Vector last = table[0];
    std::swap(next, table[0]);
    for (int k = 1; k < n; ++k) {
      const Vector extrapolated = table[k - 1] + (table[k - 1] - last) / (double(n) / (n - k) - 1);
      last = table[k];
      table[k] = extrapolated;
    }
    if (n < 3) continue;
    const Vector error = table[n - 1] - table[n - 2];
    if (std::fmax(error.head<2>().norm(), r.rho * std::fabs(error[2])) > exactness * scale) continue;
    y = table[n - 1];
    return n;
  }
  return 0;
}

// Whether slip or spin pass more of their bend at zero in a step than its points can follow: there some widths, farther
// off as much more as they keep away.
bool leaps(const Ramp& r, const Vector& y, const Vector& next) {
  CONSTANT(double, widths, 4, "widths", "the most of a bend at zero that the points of a step can follow");
  const double u = y.head<2>().norm(), u_next = next.head<2>().norm();
  const double away = y[2] * next[2] > 0 ? std::fmin(std::fabs(y[2]), std::fabs(next[2])) : 0;
  return std::fabs(next[2] - y[2]) > widths * r.width_omega + away ||
         (next - y).head<2>().norm() > widths * r.width_u + std::fmin(u, u_next);
}

// The whole ramp, in steps that
//   end at its end;
//   are short enough where friction bends: there the least is taken as it is.
void follow(const Ramp& r, double holds, bool held, double scale, Vector& y) {
  CONSTANT(double, least, 1e-14, "of the ramp", "a shorter step would move nothing but rounding");
  double reached = 0, h = 1;
  while (reached < 1) {
    h = std::fmin(h, 1 - reached);
    Vector next = y;
    const int order = step(r, h, held, scale, next);
    const bool released = held && order > 0 && std::fabs(turning(r, next)) > holds;
    if ((order == 0 || released || leaps(r, y, next)) && h > least) {
      h *= 0.4;
      continue;
    }
    if (next.allFinite()) y = next;
    held = held && !released;
    reached += h;
    h *= order > 0 && order < 7 ? 4 : 1.2;
    if (1 - reached < least) return;
  }
}

// omega_3 of a wheel that rolls, after changes by `free`, and by `friction` against its sign, which can hold it at
// zero; below zero it gives back up to there.
double spin_after(double spin, double free, double friction) {
  const double side = (spin > 0) - (spin < 0), whole = spin + free - side * friction;
  if (side * whole > 0) return whole;
  const double left = spin == 0 ? 1 : whole / (whole - spin);  // of the ramp, where the spin passes zero
  const double against = std::fmax(friction, 0);
  return std::fabs(free) <= against ? 0 : left * (free - std::copysign(against, free));
}

// (motion, rates to which the carrier jumps) => the ramp
Ramp ramp_of(const WheelScene& scene, const WheelMotion& motion, double psi_dot, double theta_dot) {
  const WheelParameters& w = scene.wheel;
  const double sine = std::sin(motion.theta), c = std::cos(motion.theta);
  const double lean = std::fabs(c) < 1e-15 ? 0 : c, eta = w.r * lean;  // of an upright wheel it is rounding
  const double d_1 = theta_dot - motion.theta_dot, d_2 = (psi_dot - motion.psi_dot) * sine;
  const double N = scene.ground == WHEEL_GROUND_PULLS ? 0 : w.m * w.r_0 * lean * d_1;
  Ramp r = {};
  r.slides = scene.contact == WHEEL_SLIDES;
  r.m = w.m;
  r.rho = w.r_0 + w.r * sine;
  r.J = w.J_z + (r.slides ? 0 : w.m * r.rho * r.rho);
  r.a_x = -eta * d_2;
  r.a_y = (w.r_0 * sine + w.r) * d_1;
  r.free = w.m * r.rho * eta * d_2 / r.J;
  r.mu_N = r.slides ? scene.mu_slide * N : 0;
  r.s_N = scene.friction.kind == WHEEL_FRICTIONLESS ? 0 : w.s * N;
  r.width_omega = scene.friction.omega_s;
  return r;
}

}  // namespace

void wheel_jump(const WheelScene* scene, double hold, double psi_dot, double theta_dot, WheelMotion* motion) {
  const double c = std::cos(motion->theta);
  const bool regularized = scene->friction.kind == WHEEL_REGULARIZED;
  Ramp r = ramp_of(*scene, *motion, psi_dot, theta_dot);
  Vector y = {motion->slip_x, motion->slip_y, motion->phi_dot + motion->psi_dot * c};
  r.kappa = regularized ? std::tanh(y[2] / r.width_omega) : (y[2] > 0) - (y[2] < 0);
  CONSTANT(double, few, 40, "widths", "where friction holds a speed at zero, it ends so close to it");
  const bool stands = regularized && ramp * hold > few * r.width_omega * r.J;
  const bool held = scene->friction.kind == WHEEL_HELD || stands;
  const double holds = std::fmax(ramp * hold + r.s_N, ramp * scene->load.brake);
  if (r.slides && (r.mu_N != 0 || r.s_N != 0)) {
    const double scale = y.head<2>().norm() + r.rho * std::fabs(y[2]) + std::fabs(r.a_x) + std::fabs(r.a_y);
    r.width_u = narrow * scale;
    if (!regularized) r.width_omega = narrow * scale / r.rho;
    follow(r, holds, held && std::fabs(turning(r, y)) <= holds, scale, y);
    if (y.head<2>().norm() < few * r.width_u) y[0] = y[1] = 0;
    if (!regularized && std::fabs(y[2]) < few * r.width_omega) y[2] = 0;
  } else if (r.slides) {
    y[0] += r.a_x;
    y[1] += r.a_y;
  } else if (const bool stays = held && std::fabs(r.free * r.J) <= holds; regularized && r.s_N > 0 && !stays) {
    follow(r, 0, false, r.rho * (std::fabs(y[2]) + std::fabs(r.free) + std::fabs(r.s_N) / r.J), y);
  } else if (!stays) {
    y[2] = spin_after(y[2], r.free, r.s_N / r.J * (regularized ? std::fabs(r.kappa) : 1));
  }
  *motion = {motion->psi, motion->theta,       motion->phi,        psi_dot, theta_dot, y[2] - psi_dot * c, motion->X_O,
             motion->Y_O, r.slides ? y[0] : 0, r.slides ? y[1] : 0};
}
