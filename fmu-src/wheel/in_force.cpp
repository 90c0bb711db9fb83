// The scene that follows from what is in force.
#include "in_force.hpp"

#include <cmath>

namespace wheel {
namespace {

WheelGround ground_of(const InForce& in_force) {
  return in_force.is_below(Event::lost_contact) ? WHEEL_GROUND_PULLS : WHEEL_GROUND_PRESSES;
}

}  // namespace

InForce::InForce(const Setup& setup) {
  scene_.wheel = setup.wheel;
  scene_.guided = setup.guided;
  scene_.contact = setup.first_contact;
}

void InForce::take_over(const Setup& setup, const Road& asked, double t, const Polynomials& polynomials) {
  road = asked;
  scene_.wheel = setup.wheel;
  scene_.wheel.s = road.s;
  if (road.slope != 0) wheel_set_slope(&scene_.wheel, setup.wheel.g_n, road.slope, road.slope_direction);
  scene_.mu_slide = std::fmin(road.mu_slide, road.mu_max);
  scene_.guided = setup.guided;
  scene_.ground = ground_of(*this);
  inputs.take_over(t, polynomials);
  inputs.set_load_at(t, scene_.load);
}

void InForce::set_below(Event event, bool below_zero) {
  below_[static_cast<int>(event)] = below_zero;
  scene_.ground = ground_of(*this);
}

}  // namespace wheel
