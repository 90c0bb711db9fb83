// Jumps of the wheel carrier's rates: y changes by f(y, turn) - f(y, 0), where `turn` holds the jumps in the place of
// the carrier's accelerations, in which f is linear.
#include "guide.hpp"

#include <algorithm>
#include <cmath>

namespace wheel {
namespace {

struct Jump {
  const Setup& setup;
  const WheelScene& scene;
  double turn[2];  // rad/s, of psi_dot and theta_dot
};

// What the whole jump would change at the state y under a law that stays.
Rates change_of(const Jump& jump, const WheelFriction& law, const double* y) {
  WheelScene scene = jump.scene;
  scene.friction = law;
  std::fill_n(scene.load.turn, 2, 0.0);
  const Rates rest = rates_of(jump.setup, scene, y);
  std::copy_n(jump.turn, 2, scene.load.turn);
  Rates change = rates_of(jump.setup, scene, y);
  for (int i = 0; i < formulation_of(jump.setup, scene).states; ++i) change.y_dot[i] -= rest.y_dot[i];
  return change;
}

// rad/s, omega_z after a jump that changes it by `free` without friction, and by `friction` more against its sign;
// below zero where the ramp relieves the ground. At zero friction holds it if it can, and else acts against `free`.
double spin_after(double spin, double free, double friction, double rounding) {
  if (spin == 0 && std::fabs(free) <= std::fmax(friction, 0) + rounding) return 0;
  const double side = std::copysign(1, spin == 0 ? free : spin), whole = spin + free - side * friction;
  if (side * whole >= 0) return whole;
  const double left = whole / (whole - spin);  // of the jump, where the spin passes zero
  return spin_after(0, left * free, left * friction, rounding);
}

// Moves y by a part of the jump, of which law and direction of the slip are those at the state `at`.
void move_by(const Jump& jump, double part, const double* at, double* y) {
  const Setup& setup = jump.setup;
  const WheelFormulation& f = formulation_of(setup, jump.scene);
  const int spin = f.spin_index, slip = f.slip_index;
  const Rates free = change_of(jump, {WHEEL_FRICTIONLESS, 0, 0}, at);
  const Rates rubbed = change_of(jump, {WHEEL_ROLLING, 1, 0}, at);
  const double whole = rubbed.y_dot[spin] - free.y_dot[spin];  // rad/s, by all friction against a forward spin
  const double kappa = setup.friction_law == regularized_law ? std::fabs(std::tanh(at[spin] / setup.omega_s)) : 1;
  const double after = spin_after(y[spin], part * free.y_dot[spin], -part * kappa * whole, 1e-14 * setup.rate_scale);
  const double share = whole != 0 ? (after - y[spin] - part * free.y_dot[spin]) / whole : 0;
  const auto change = [&](int i) { return part * free.y_dot[i] + share * (rubbed.y_dot[i] - free.y_dot[i]); };
  if (slip >= 0) {  // a vector, here along e1 and to the left
    const double along = change(slip), across = at[slip] * change(slip + 1), cosine = std::cos(at[slip + 1]),
                 sine = std::sin(at[slip + 1]);
    const double x = y[slip] * std::cos(y[slip + 1]) + along * cosine - across * sine;
    const double left = y[slip] * std::sin(y[slip + 1]) + along * sine + across * cosine;
    y[slip] = std::sqrt(x * x + left * left);
    y[slip + 1] = wheel_angle_of(x, left);
  }
  for (int i = 0; i < f.states; ++i)
    if (slip < 0 || (i != slip && i != slip + 1)) y[i] += change(i);
  y[spin] = after;
}

// The part of a jump in which direction of the slip and regularized law change little at the state y.
double part_at(const Jump& jump, const double* y) {
  constexpr double little = 0.02, least = 1.0 / 1024;
  const WheelFormulation& f = formulation_of(jump.setup, jump.scene);
  const int spin = f.spin_index, slip = f.slip_index;
  const Rates change = change_of(jump, {WHEEL_ROLLING, 1, 0}, y);
  double part = 1;
  if (slip >= 0) part = y[slip] / std::hypot(change.y_dot[slip], y[slip] * change.y_dot[slip + 1]);
  if (jump.setup.friction_law == regularized_law)
    part = std::fmin(part, jump.setup.omega_s / std::fabs(change.y_dot[spin]));
  return std::fmax(little * part, least);
}

}  // namespace

// In one part where nothing but the sign of the spin bends the ramp. Else by the midpoint rule in several.
void turn_carrier(const Setup& setup, const WheelScene& scene, double psi_dot, double theta_dot, double* y) {
  const WheelFormulation& f = formulation_of(setup, scene);
  const double* const across = y + f.spin_index - 2;  // the rates across the axle
  if (psi_dot == 0 && theta_dot == 0 && across[0] == 0 && across[1] == 0) return;
  WheelKinematics k;
  f.kinematics(&scene.wheel, y, &k);
  const Jump jump = {setup, scene, {psi_dot - k.psi_dot, theta_dot - k.theta_dot}};
  if (jump.turn[0] == 0 && jump.turn[1] == 0) return;
  const bool bends = jump.turn[1] != 0 && (scene.contact == WHEEL_SLIDES || setup.friction_law == regularized_law);
  for (double left = 1, part; left > 0; left -= part) {
    double at[WHEEL_MAX_STATES];
    std::copy_n(y, WHEEL_MAX_STATES, at);
    part = bends ? std::fmin(part_at(jump, y), left) : 1;
    if (bends) move_by(jump, 0.5 * part, y, at);
    move_by(jump, part, at, y);
  }
}

}  // namespace wheel
