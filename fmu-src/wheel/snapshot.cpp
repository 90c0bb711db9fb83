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

constexpr std::uint64_t mark = 0x3530554d46484557;  // "WEHFMU05": a change of the layout raises the number

struct Header {
  std::uint64_t mark, size, checksum;
};

template <class Archive>
void visit(Archive& archive, Inputs& inputs) {
  archive.number(inputs.origin);
  archive.numbers(inputs.in_force[0], Inputs::count * (Inputs::max_order + 1));
  for (auto& polynomial : inputs.pending) {
    archive.anything(polynomial[0]);
    archive.numbers(polynomial + 1, Inputs::max_order);
  }
}

// State that cannot be rebuilt from the parameters. The law of friction and the method are included because s and the
// inputs may have changed since they were chosen.
template <class Archive>
void visit(Archive& archive, State& state) {
  constexpr long long most = 9007199254740992;
  Motion& motion = state.motion;
  for (double& parameter : state.parameters) archive.anything(parameter);
  archive.number(state.start_time);
  archive.range(motion.tolerance, tightest_tolerance, loosest_tolerance);
  archive.range(motion.scene.wheel.s, 0, Archive::greatest);
  archive.count(motion.scene.friction.kind, WHEEL_NO_LAW, WHEEL_REGULARIZED);
  archive.number(motion.scene.friction.sigma), archive.number(motion.scene.friction.omega_s);
  visit(archive, motion.inputs);
  archive.count(state.method, 0, static_cast<int>(solver::Method::runge_kutta));
  archive.count(state.ending, 0, static_cast<int>(Event::fell_flat));
  archive.truths(state.prepared, state.started, state.moving, state.unfolded, state.jumped, state.changes_pending);
  archive.count(motion.scene.ground, WHEEL_GROUND_BY_FORCE, WHEEL_GROUND_PULLS);
  archive.number(state.t), archive.number(state.last_change);
  archive.numbers(state.y, WHEEL_MAX_STATES);
  solver::Counters& counted = state.counted;
  for (long long* count :
       {&state.transitions, &counted.steps, &counted.rhs, &counted.jacobians, &counted.roots, &counted.restarts})
    archive.count(*count, 0, most);
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
  const WheelGround ground = motion.scene.ground;
  return law_is_sound(motion.scene.friction, state.parameters[omega_s]) &&
         (ground == WHEEL_GROUND_PRESSES || (motion.keep_contact && ground == WHEEL_GROUND_PULLS)) &&
         state.last_change >= 0 && state.last_change <= state.t && (unfoldable || !state.unfolded) &&
         (state.moving ? state.started : state.t == 0 && state.ending == Event::none);
}

// The run that the bytes describe; what follows from its parameters is computed anew. False where no run can have been
// saved as these bytes.
bool read_run(support::Reader& reader, State& state) {
  visit(reader, state);
  if (!reader.good) return false;
  if (!state.prepared) return !state.started && !state.moving;
  if (!check_values(state.parameters, state.motion.inputs, nullptr, nullptr)) return false;
  State start = state;
  set_initial_state(start);
  const WheelFriction law = state.motion.scene.friction;
  const double s_in_force = state.motion.scene.wheel.s;
  const Inputs inputs = state.motion.inputs;
  const WheelGround ground = state.motion.scene.ground;
  state.motion = start.motion;
  state.motion.scene.friction = law;
  state.motion.scene.wheel.s = s_in_force;
  state.motion.inputs = inputs;
  state.motion.scene.ground = ground;
  state.motion.inputs.classify();
  state.motion.inputs.load_at(state.t, &state.motion.scene.load);
  state.y_known = true;
  return run_is_sound(state);
}

}  // namespace

std::size_t Simulation::state_size() {
  support::Measure measure;
  visit(measure, state_);
  return sizeof(Header) + measure.bytes + (state_.is_stepping() ? solver_.history_size() : 0);
}

void Simulation::save_state(unsigned char* bytes) {
  if (state_.prepared) y_now();
  support::Writer writer(bytes + sizeof(Header));
  visit(writer, state_);
  if (state_.is_stepping()) solver_.save_history(writer.at);
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
  support::Reader reader(bytes + sizeof(Header), size - sizeof(Header));
  State next;
  if (!read_run(reader, next)) return false;
  if (next.is_stepping() ? !restore_solver(next, reader.at, static_cast<std::size_t>(reader.end - reader.at))
                         : reader.at != reader.end)
    return false;
  state_ = next;
  reading_fresh_ = orbit_ready_ = false;
  return true;
}

}  // namespace wheel
