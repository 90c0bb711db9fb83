// What can happen at an instant that is not known beforehand. Each event is the fall of a watched function below zero;
// the list of these is in motion.cpp, what follows in Simulation::pass_event.
#pragma once

namespace wheel {

enum class Event : int {
  none,
  spin_changes,     // omega_z reaches zero, or friction and brake can no longer hold it there
  layer_changes,    // omega_z enters or leaves the layer of a stiff regularized law, or begins to stick in it
  contact_changes,  // with keep_contact: the ground begins to pull or to press
  lifted_off,
  fell_flat,
  count
};

// Events that end the model, and what is said of them, to stand behind "the wheel".
struct Ending {
  Event event;
  const char* said;
};
inline constexpr Ending endings[] = {
    {Event::lifted_off, "lifted off the ground"},
    {Event::fell_flat, "fell flat"},
};

// Null for an event that ends nothing.
constexpr const char* ending_of(Event event) {
  for (const Ending& ending : endings)
    if (ending.event == event) return ending.said;
  return nullptr;
}

}  // namespace wheel
