// The complete state of a run as portable bytes: a header (mark, size, checksum), then numbers of 8 bytes each, then
// the solver's own history. Bytes may come from anywhere: each number is checked before it is used.
#include <cmath>
#include <cstring>

#include "bytes.hpp"
#include "checks.hpp"
#include "decisions.hpp"
#include "scene.hpp"
#include "simulation.hpp"

namespace wheel {
namespace {

constexpr std::uint64_t mark = 0x3430554d46484557;  // "WEHFMU04": a change of the layout raises the number

struct Header {
  std::uint64_t mark, size, checksum;
};

template <class Archive>
void visit(Archive& archive, Inputs& inputs) {
  archive(inputs.origin);
  for (auto* block : {&inputs.in_force, &inputs.pending})
    for (auto& polynomial : *block) support::many(archive, polynomial, Inputs::max_order + 1);
}

// State that cannot be rebuilt from the parameters. The law of friction and the method are included because s and the
// inputs may have changed since they were chosen.
template <class Archive>
void visit(Archive& archive, State& state) {
  Motion& motion = state.motion;
  support::many(archive, state.parameters, first_input);
  support::all(archive, state.start_time, motion.tolerance, motion.scene.wheel.s);
  support::choice(archive, motion.scene.friction.kind, WHEEL_NO_LAW, WHEEL_REGULARIZED);
  support::all(archive, motion.scene.friction.sigma, motion.scene.friction.omega_s);
  visit(archive, motion.inputs);
  support::choice(archive, state.method, solver::Method::adams, solver::Method::runge_kutta);
  support::choice(archive, state.ending, Ending::none, Ending::lifted_off);
  support::all(archive, state.prepared, state.started, state.moving, state.unfolded, state.jumped,
               state.changes_pending, state.pulling, state.t, state.last_change);
  support::many(archive, state.y, WHEEL_MAX_STATES);
  support::all(archive, state.transitions, state.counted.steps, state.counted.rhs, state.counted.jacobians,
               state.counted.roots, state.counted.restarts);
}

template <class Number>
bool all_finite(const Number* numbers, int count) {
  for (int i = 0; i < count; ++i)
    if (!std::isfinite(numbers[i])) return false;
  return true;
}

bool inputs_are_sound(const Inputs& inputs) {
  return all_finite(inputs.in_force[0], sizeof inputs.in_force / sizeof(double)) &&
         all_finite(inputs.pending[0], sizeof inputs.pending / sizeof(double)) && std::isfinite(inputs.origin);
}

// Whether the law is one that friction_at could have chosen.
bool law_is_sound(const WheelFriction& law, double width) {
  switch (law.kind) {
    case WHEEL_ROLLING:
      return std::fabs(law.sigma) == 1;
    case WHEEL_REGULARIZED:
      return law.omega_s == width;
    case WHEEL_NO_LAW:
      return false;
    default:
      return true;
  }
}

// For a run that has an initial state. `state` already has the scales that its parameters give.
bool run_is_sound(const State& state) {
  const Motion& motion = state.motion;
  const bool unfoldable = is_unfoldable(state.parameters, motion.scene, motion.inputs.loaded);
  return inputs_are_sound(motion.inputs) && law_is_sound(motion.scene.friction, state.parameters[omega_s]) &&
         all_finite(state.y, motion.formulation->states) && motion.scene.wheel.s >= 0 &&
         std::isfinite(motion.scene.wheel.s) && std::isfinite(state.t) && state.last_change >= 0 &&
         state.last_change <= state.t &&
         (state.moving ? state.started : state.t == 0 && state.ending == Ending::none) &&
         (unfoldable || !state.unfolded);
}

bool tolerance_is_sound(double tolerance) { return tolerance >= tightest_tolerance && tolerance <= loosest_tolerance; }

bool is_stepping(const State& state) { return state.moving && !state.unfolded; }

// The run that the bytes describe; what follows from its parameters is computed anew. False where no run can have been
// saved as these bytes.
bool read_run(support::Reader& reader, State& state) {
  visit(reader, state);
  if (!reader.sound || !tolerance_is_sound(state.motion.tolerance) || !std::isfinite(state.start_time)) return false;
  if (!state.prepared) return !state.started && !state.moving;
  if (!check_values(state.parameters, state.motion.inputs, nullptr, nullptr)) return false;
  State start = state;
  set_initial_state(start);
  const WheelFriction law = state.motion.scene.friction;
  const double s_in_force = state.motion.scene.wheel.s;
  const Inputs inputs = state.motion.inputs;
  state.motion = start.motion;
  state.motion.scene.friction = law;
  state.motion.scene.wheel.s = s_in_force;
  state.motion.inputs = inputs;
  state.motion.inputs.classify();
  state.motion.inputs.load_at(state.t, &state.motion.scene.load);
  state.y_known = true;
  return run_is_sound(state);
}

}  // namespace

std::size_t Simulation::state_size() {
  support::Measure measure;
  visit(measure, state_);
  return sizeof(Header) + measure.bytes + (is_stepping(state_) ? solver_.history_size() : 0);
}

void Simulation::save_state(unsigned char* bytes) {
  if (state_.prepared) y_now();
  support::Writer writer{bytes + sizeof(Header)};
  visit(writer, state_);
  if (is_stepping(state_)) solver_.save_history(writer.at);
  const std::size_t size = state_size();
  const Header header = {mark, size, support::checksum_of(bytes + sizeof(Header), size - sizeof(Header))};
  std::memcpy(bytes, &header, sizeof header);
}

bool Simulation::is_state(const unsigned char* bytes, std::size_t size) {
  Header header;
  if (size < sizeof header) return false;
  std::memcpy(&header, bytes, sizeof header);
  return header.mark == mark && header.size == size &&
         support::has_checksum(bytes + sizeof header, size - sizeof header, header.checksum);
}

// The solver's problem refers to this instance's state_, but its sizes are those of the run that is restored.
bool Simulation::restore_solver(const State& next, const unsigned char* history, std::size_t size) {
  State run = next;
  solver::Problem problem = problem_of(run.motion);
  problem.owner = &state_.motion;
  return solver_.restore_history(problem, history, size) && solver_.step_start() <= next.t && solver_.reaches(next.t);
}

bool Simulation::load_state(const unsigned char* bytes, std::size_t size) {
  if (!is_state(bytes, size)) return false;
  support::Reader reader{bytes + sizeof(Header), size - sizeof(Header)};
  State next;
  if (!read_run(reader, next)) return false;
  if (is_stepping(next) ? !restore_solver(next, reader.at, reader.left) : reader.left != 0) return false;
  state_ = next;
  reading_fresh_ = false;
  return true;
}

}  // namespace wheel
