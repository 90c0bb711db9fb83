// Quantities at one instant, on request. Fixed axes.
#include "reading.hpp"

#include <algorithm>

#include "simulation.hpp"

namespace wheel {

// True once per part and instant; marks it as present.
bool Reading::missing(unsigned part) {
  const bool absent = !(have_ & part);
  have_ |= part;
  return absent;
}

void Reading::set_state(double t, const double* y) {
  move_to(t);
  std::copy_n(y, formulation_->states, y_);
  have_ = have_state;
}

const double* Reading::state() {
  if (missing(have_state)) simulation_->solution()->read(t_, y_);
  return y_;
}

const WheelScene& Reading::scene() {
  if (missing(have_scene)) scene_ = simulation_->scene_at(t_, state());
  return scene_;
}

const WheelKinematics& Reading::pose() {
  if (!(have_ & have_kinematics) && missing(have_pose))
    formulation_->pose(&simulation_->wheel(), state(), &kinematics_);
  return kinematics_;
}

const WheelKinematics& Reading::kinematics() {
  if (missing(have_kinematics)) formulation_->kinematics(&simulation_->wheel(), state(), &kinematics_);
  return kinematics_;
}

const WheelDynamics& Reading::dynamics() {
  if (missing(have_dynamics)) formulation_->dynamics(&scene(), state(), &dynamics_);
  return dynamics_;
}

const double* Reading::reaction_rates() {
  if (missing(have_rates)) {
    const WheelLoad load_dot = simulation_->load_rate_at(t_);
    formulation_->reaction_rates(&scene(), &load_dot, state(), rates_);
  }
  return rates_;
}

int Reading::friction_mode() {
  const WheelFriction& friction = scene().friction;
  if (friction.kind == WHEEL_HELD) return 0;
  if (friction.kind == WHEEL_ROLLING) return friction.sigma > 0 ? 1 : -1;
  const double omega_z = kinematics().omega_z;
  return (omega_z > 0) - (omega_z < 0);
}

Counts Reading::counters() const {
  if (!simulation_->solution()) return {};
  const integrator::Counters& c = simulation_->solution()->counters();
  return {c.steps, c.rhs, c.jacobians, c.roots, events, c.restarts};
}

}  // namespace wheel
