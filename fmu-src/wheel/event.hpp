// What can happen at an instant that is not known beforehand. Each event is the fall of a watched function below zero;
// the list of these is in motion.cpp, what follows in Simulation::pass_event.
#pragma once

namespace wheel {

enum class Event : int {
  none,
  spin_changes,     // omega_z reaches zero, or friction and brake can no longer hold it there
  layer_changes,    // a regularized law becomes stiff; omega_z enters or leaves its layer, or begins to stick in it
  contact_changes,  // with keep_contact: the ground begins to pull or to press
  lifted_off,
  fell_flat,
  count
};

// What is said of an event that ends the model, to stand behind "the wheel"; null for one that ends nothing.
constexpr const char* ending_of(Event event) {
  if (event == Event::lifted_off) return "lifted off the ground";
  if (event == Event::fell_flat) return "fell flat";
  return nullptr;
}

}  // namespace wheel
