// Quantities at one instant, on request.
#include "reading.hpp"

#include <cmath>

namespace wheel {

// True once per part and instant; marks it as present.
bool Reading::missing(unsigned part) {
  const bool absent = !(have_ & part);
  have_ |= part;
  return absent;
}

const WheelKinematics& Reading::kinematics() {
  if (missing(have_kinematics)) formulation().kinematics(&now_.scene.wheel, now_.y, &kinematics_);
  return kinematics_;
}

const WheelDynamics& Reading::dynamics() {
  if (missing(have_dynamics)) formulation().dynamics(&now_.scene, now_.y, &dynamics_);
  return dynamics_;
}

double Reading::horizontal_force(int axis) {
  double force[2];
  wheel_horizontal_force(&kinematics(), dynamics().lambda, force);
  return force[axis];
}

double Reading::slip(int axis) const {
  if (contact_mode() == WHEEL_GRIPS) return 0;
  const double* const u = now_.y + formulation().slip_index;
  return u[0] * (axis == 0 ? std::cos(u[1]) : std::sin(u[1]));
}

Force Reading::force() {
  const WheelDynamics& now = dynamics();
  const WheelScene& scene = now_.scene;
  return {{now.lambda[0], now.lambda[1], now.lambda[2]}, {now.tau, now.lambda[2], scene.wheel.s, scene.load.brake}};
}

double Reading::brake_moment() {
  const WheelAxleMoment axle = force().axle;
  return wheel_brake_moment(&axle);
}

double Reading::guide_moment(int axis) {
  double moment[2] = {};
  const WheelScene& scene = now_.scene;
  if (scene.guided) wheel_guide_moment(&scene.wheel, &kinematics(), dynamics().lambda, scene.load.M, moment);
  return moment[axis];
}

const WheelContact& Reading::contact() {
  if (missing(have_contact)) contact_ = wheel_contact(&now_.scene.wheel, &kinematics());
  return contact_;
}

double Reading::energy() {
  WheelKinematics whole = kinematics();
  whole.X_O = setup().X_O.whole(whole.X_O);
  whole.Y_O = setup().Y_O.whole(whole.Y_O);
  return wheel_energy(&now_.scene.wheel, &whole);
}

int Reading::friction_mode() {
  const WheelFriction& friction = now_.scene.friction;
  if (friction.kind == WHEEL_HELD) return 0;
  if (friction.kind == WHEEL_ROLLING) return friction.sigma > 0 ? 1 : -1;
  const double omega_z = kinematics().omega_z;
  return (omega_z > 0) - (omega_z < 0);
}

}  // namespace wheel
