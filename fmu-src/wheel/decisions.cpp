// Initial state and changes during a run. Pure functions of a run's state.
#include "decisions.hpp"

#include <algorithm>

#include "scene.hpp"

namespace wheel {
void set_initial_state(State& state) {
  State start;
  std::copy_n(state.parameters, first_input, start.parameters);
  start.start_time = state.start_time;
  start.motion.tolerance = state.motion.tolerance;
  start.motion.inputs = state.motion.inputs;
  start.motion.inputs.origin = 0;
  start.motion.formulation = &choose_formulation(state.parameters);
  start.motion.keep_contact = state.parameters[keep_contact] != 0;
  start.motion.scene.wheel = parameters_from(state.parameters);
  start.motion.scene.ground = WHEEL_GROUND_PRESSES;
  const WheelMotion motion = initial_motion(state.parameters);
  start.motion.formulation->start(&start.motion.scene.wheel, &motion, start.y);
  start.y_known = true;
  set_scales(start.motion, start.y);
  take_changes(start, start.y);
  state = start;
}

void take_changes(State& state, const double* y) {
  Motion& motion = state.motion;
  state.changes_pending = false;
  motion.scene.wheel.s = state.parameters[s];
  motion.inputs.take_over(state.t);
  motion.inputs.load_at(state.t, &motion.scene.load);
  motion.scene.friction =
      friction_at(state.parameters, *motion.formulation, motion.scene, motion.inputs.braked, motion.weight, y);
  state.unfolded = !state.jumped && is_unfoldable(state.parameters, motion.scene, motion.inputs.loaded);
  state.method = choose_method(state.parameters, motion.scene, state.jumped || motion.inputs.varies);
}

WheelScene pending_scene(const State& state) {
  const Motion& motion = state.motion;
  WheelScene scene = motion.scene;
  scene.wheel.s = state.parameters[s];
  motion.inputs.pending_load(&scene.load);
  scene.friction =
      friction_at(state.parameters, *motion.formulation, scene, motion.inputs.pending_brake(), motion.weight, state.y);
  return scene;
}

WheelFriction braked_friction(const State& state, const WheelScene& scene, const double* y) {
  if (scene.friction.kind != WHEEL_FRICTIONLESS) return scene.friction;
  return friction_at(state.parameters, *state.motion.formulation, scene, true, state.motion.weight, y);
}

}  // namespace wheel
