// What acts on a wheel from an instant on: road, inputs, the mode of rolling, the contact, and the sides of observed
// events. Which of them follow from which is decided in law.cpp and events.cpp.
#pragma once

#include "setup.hpp"

namespace wheel {

// What can happen at an instant that is not known beforehand. These are the names of the rows of the table in
// events.cpp. In co-simulation the later one in this list counts of two events at the same instant; in model exchange
// all count.
enum class Event : int {
  none,
  changes_layer,  // omega_z enters or leaves the layer of a regularized law
  spin_changes,   // omega_z reaches zero, or rolling resistance and brake can no longer hold it
  lost_grip,      // the wheel needs a friction coefficient above mu_max
  slip_ends,      // the slip falls to zero
  lost_contact,   // N falls below zero, or rises above it while the ground pulls
  jams,           // no N satisfies the equations of the sliding wheel
  lies_flat,
  count
};
inline constexpr int event_count = static_cast<int>(Event::count);

// The road, which may change during a run.
struct Road {
  double s, mu_max, mu_slide, slope, slope_direction;
  bool operator==(const Road&) const = default;
};

inline Road road_asked(const Demand& demand) {
  const double* v = demand.parameters;
  return {v[variable::s], v[variable::mu_max], v[variable::mu_slide], v[variable::slope], v[variable::slope_direction]};
}

// What acts on the wheel, and the scene that follows from it for the equations: plain numbers.
class InForce {
 public:
  // Written by take_over, and where a saved state is read.
  Road road = {};  // as it was asked for
  Inputs inputs;

  InForce() = default;
  // The state before anything is set: a level road, no inputs and no mode.
  explicit InForce(const Setup& setup);
  // Road and inputs are in force from t on. A mu_max that was set below mu_slide counts for both.
  void take_over(const Setup& setup, const Road& asked, double t, const Polynomials& polynomials);
  // The value of an observed event has fallen below zero, or has risen above it.
  void set_below(Event event, bool below_zero);
  // Decided in law.cpp: the mode of rolling, and whether the wheel grips or slides.
  void set_mode(const WheelFriction& mode) { scene_.friction = mode; }
  void set_contact(WheelContactMode contact) { scene_.contact = contact; }

  bool is_below(Event event) const { return below_[static_cast<int>(event)]; }
  const WheelFriction& mode() const { return scene_.friction; }
  WheelContactMode contact() const { return scene_.contact; }
  bool slides() const { return scene_.contact == WHEEL_SLIDES; }
  WheelGround ground() const { return scene_.ground; }
  double mu_slide() const { return scene_.mu_slide; }

  WheelScene scene_at(double t) const { return inputs.varies ? loaded_at(t) : scene_; }
  // The same, which is copied into `room` only where an input varies.
  const WheelScene& scene_at(double t, WheelScene& room) const { return inputs.varies ? room = loaded_at(t) : scene_; }

 private:
  WheelScene loaded_at(double t) const {
    WheelScene scene = scene_;
    inputs.set_load_at(t, scene.load);
    return scene;
  }

  bool below_[event_count] = {};  // of each observed event: its value lies below zero
  WheelScene scene_ = {};         // with the load at the instant from which the inputs count
};

}  // namespace wheel
