// The scene that follows from what is in force.
#include "run.hpp"

#include <cmath>

namespace wheel {
namespace {

WheelGround ground_of(const InForce& in_force) {
  return in_force.is_below(Event::lost_contact) ? WHEEL_GROUND_PULLS : WHEEL_GROUND_PRESSES;
}

}  // namespace

void InForce::take_over(const Setup& setup, const Road& asked, double t, const Polynomials& polynomials) {
  road = asked;
  scene.wheel = setup.scene.wheel;
  scene.wheel.s = road.s;
  if (road.slope != 0) wheel_set_slope(&scene.wheel, setup.scene.wheel.g_n, road.slope, road.slope_direction);
  scene.mu_slide = std::fmin(road.mu_slide, road.mu_max);
  scene.guided = setup.scene.guided;
  scene.ground = ground_of(*this);
  inputs.take_over(t, polynomials);
  inputs.set_load_at(t, scene.load);
}

void InForce::cross(Event event) {
  below[static_cast<int>(event)] = !is_below(event);
  scene.ground = ground_of(*this);
}

}  // namespace wheel
