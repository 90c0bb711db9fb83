// A jump of the rates at which a wheel carrier turns the wheel: the limit of ever steeper ramps. Of a ramp in which
// omega_1 and omega_2 change by d_1 and d_2, over a part of it from 0 to 1 and in the symbols of sliding.c:
//   rolls   (J_z + m rho^2) omega_3_dot = m rho eta d_2 + tau
//   slides  J_z omega_3_dot = rho f_x + tau,  u_x_dot = f_x / m - eta d_2 + rho omega_3_dot,  u_y_dot = f_y / m + h d_1
// with |tau| <= s N, f = -mu_slide N u / |u| and N = m l d_1. Brake and weight are too weak for so steep a ramp. But a
// jump stands for a ramp as long as a communication step, and a held wheel that they would hold over one of a
// millisecond stays held.
#include <cmath>

#include "wheel_equations.h"

namespace {

constexpr double ramp = 1e-3;  // s

// omega_3 after changes by `free`, and by `friction` against its sign, which can hold it at zero. Where the ramp
// relieves the ground, friction is negative: it gives back to a spin, but drives no wheel that stands.
double spin_after(double spin, double free, double friction) {
  const double side = (spin > 0) - (spin < 0), whole = spin + free - side * friction;
  if (side * whole > 0) return whole;
  const double left = spin == 0 ? 1 : whole / (whole - spin);  // of the ramp, where the spin passes zero
  const double against = std::fmax(friction, 0);
  return std::fabs(free) <= against ? 0 : left * (free - std::copysign(against, free));
}

}  // namespace

// Where friction bends the ramp, by the midpoint rule in many parts.
void wheel_jump(const WheelScene* scene, double hold, double psi_dot, double theta_dot, WheelMotion* motion) {
  const WheelParameters& w = scene->wheel;
  const double s = std::sin(motion->theta), c = std::cos(motion->theta), rho = w.r_0 + w.r * s;
  const double lean = std::fabs(c) < 1e-15 ? 0 : c, eta = w.r * lean;  // of an upright wheel it is rounding
  const double d_1 = theta_dot - motion->theta_dot, d_2 = (psi_dot - motion->psi_dot) * s;
  const double N = scene->ground == WHEEL_GROUND_PULLS ? 0 : w.m * w.r_0 * lean * d_1,
               omega_s = scene->friction.omega_s;
  const bool slides = scene->contact == WHEEL_SLIDES;
  const double inertia = w.J_z + (slides ? 0 : w.m * rho * rho), mu = slides ? scene->mu_slide : 0;
  struct Place {
    double u_x, u_y, omega_3;
  } now = {motion->slip_x, motion->slip_y, motion->phi_dot + motion->psi_dot * c};
  const auto move_by = [&](double part, const Place& at) {
    const double u = std::sqrt(at.u_x * at.u_x + at.u_y * at.u_y), f = u > 0 ? part * mu * N / u : 0;
    const double kappa = omega_s > 0 ? std::fabs(std::tanh(at.omega_3 / omega_s)) : 1, spin = now.omega_3;
    const double free = slides ? -rho * f * at.u_x : part * w.m * rho * eta * d_2;
    const double friction = part * kappa * w.s * N / inertia;
    const double holds = std::fmax(ramp * hold + w.s * N, ramp * scene->load.brake);
    const bool held = scene->friction.kind == WHEEL_HELD && std::fabs(free) <= part * holds;
    const double omega_3 = held ? spin : spin_after(spin, free / inertia, friction);
    return Place{now.u_x - f * at.u_x / w.m - part * eta * d_2 + rho * (omega_3 - spin),
                 now.u_y - f * at.u_y / w.m + part * (w.r_0 * s + w.r) * d_1, omega_3};
  };
  const int parts = N != 0 && (slides || omega_s > 0) ? 128 : 1;
  for (int i = 0; i < parts; ++i) now = move_by(1.0 / parts, move_by(0.5 / parts, now));
  const double slip_x = slides ? now.u_x : 0, slip_y = slides ? now.u_y : 0;
  *motion = {motion->psi, motion->theta, motion->phi, psi_dot, theta_dot, now.omega_3 - psi_dot * c,
             motion->X_O, motion->Y_O,   slip_x,      slip_y};
}
