// The state as bytes. They may come from anywhere: whatever they are, reading them is harmless.
#include "snapshot.hpp"

#include <algorithm>
#include <cstring>
#include <string_view>

#include "bytes.hpp"
#include "events.hpp"
#include "law.hpp"
#include "posed_problem.hpp"

namespace wheel {
namespace {

constexpr const char* forged = "a number is out of its bounds";

// Of this FMU and version, by its GUID, which follows from the description and its version, and of a kind of instance.
std::uint64_t mark_of(Kind kind) {
  constexpr std::string_view guid = WHEEL_GUID;
  return support::checksum_of(reinterpret_cast<const unsigned char*>(guid.data()), guid.size()) +
         static_cast<std::uint64_t>(kind);
}

struct Header {
  std::uint64_t mark, size, checksum;
};

// The functions `visit` pass over all that the caller has set, and all of the run that does not follow from it. A new
// member of Demand, InForce or Run belongs here too, or `complete` computes it: structured bindings and the size of
// InForce remind of it, in Run only this sentence. The bounds keep forged numbers harmless, not meaningful.
static_assert(sizeof(InForce) == sizeof(Road) + sizeof(Inputs) + (event_count + 7) / 8 * 8 + sizeof(WheelScene) ||
              alignof(InForce) != 8);

void visit(support::Archive& archive, Demand& demand) {
  auto& [parameters, inputs, start_time, stop_time, tolerance, kind] = demand;  // the kind is in the mark
  for (double& parameter : parameters) archive.anything(parameter);
  archive.number(start_time);
  archive.range(stop_time, -archive.greatest, solver::never);
  archive.range(tolerance, tightest_tolerance, loosest_tolerance);
  for (auto& input : inputs) {
    archive.anything(input[0]);
    archive.numbers(input + 1, max_order);
  }
}

void visit(support::Archive& archive, InForce& in_force) {
  auto& [s, mu_max, mu_slide, slope, slope_direction] = in_force.road;
  for (double* x : {&s, &mu_max, &mu_slide}) archive.range(*x, 0, archive.greatest);
  archive.range(slope, 0, upright);
  archive.range(slope_direction, -largest_angle, largest_angle);
  WheelFriction mode = in_force.mode();
  WheelContactMode contact = in_force.contact();
  archive.count(mode.kind, WHEEL_NO_LAW, WHEEL_REGULARIZED);
  archive.range(mode.sigma, -1, 1);
  archive.count(contact, WHEEL_GRIPS, WHEEL_SLIDES);
  in_force.set_mode(mode);
  in_force.set_contact(contact);
  auto& [origin, c, loaded, braked, varies, guides] = in_force.inputs;  // the last four follow from c
  archive.number(origin);
  for (auto& input : c) archive.numbers(input, max_order + 1);
  for (int i = 0; i < event_count; ++i) {
    bool below = in_force.is_below(static_cast<Event>(i));
    archive.count(below, 0, 1);
    in_force.set_below(static_cast<Event>(i), below);
  }
}

void visit(support::Archive& archive, Run& run, Kind kind) {
  archive.count(run.pending, 0, static_cast<int>(Pending::set));
  archive.count(run.can_slide, 0, 1);
  archive.count(run.phase, 0, phase_count - 1);
  archive.count(run.ended_by, 0, event_count - 1);
  visit(archive, run.in_force);
  archive.number(run.t, run.last_change);
  archive.range(run.grip_due, 0, solver::never);
  double x[WHEEL_EULER_STATES], y[max_states];
  std::copy_n(run.x(), WHEEL_EULER_STATES, x);
  std::copy_n(run.latest_y(), max_states, y);
  kind == Kind::model_exchange ? archive.numbers(x, WHEEL_EULER_STATES) : archive.numbers(y, max_states);
  kind == Kind::model_exchange ? run.set_x(x) : run.set_y(y);
  for (bool& logged : run.logged) archive.count(logged, 0, 1);
  archive.tally(run.transitions);
  for (long long* count : run.counted.all()) archive.tally(*count);
}

void visit(support::Archive& archive, Record& record) {
  visit(archive, record.demand);
  visit(archive, record.run, record.demand.kind);
}

// Completes a run that was read, by all that follows from its demand. False where the demand describes no wheel, or the
// run names an equation or an event that does not exist.
bool complete(Record& record) {
  auto& [demand, setup, run] = record;
  if (run.phase == Phase::faulty) run.phase = Phase::initializing;  // the faults are logged again
  const bool ended = run.ended_by != Event::none;
  if (ended ? !event_row(run.ended_by).ending : run.phase == Phase::ended) return false;
  if (!has_state(run.phase)) return true;
  if (!check_values(demand, run.can_slide, Checked::during_run, Reporter())) return false;
  setup = setup_of(demand, run.can_slide);
  InForce& in_force = run.in_force;
  // Copies, because take_over writes over what it reads. It brings the ground in line with what was read of the events.
  in_force.take_over(setup, Road(in_force.road), in_force.inputs.origin, Inputs(in_force.inputs).c);
  WheelFriction mode = in_force.mode();
  mode.omega_s = mode.kind == WHEEL_REGULARIZED ? setup.omega_s : 0;
  in_force.set_mode(mode);
  return setup.can_slide() || !in_force.slides();
}

void write(Wheel& w, support::Archive& archive) {
  if (has_state(w.run.phase)) update_state(w);
  visit(archive, w);
  if (w.run.phase == Phase::stepping) w.solver.save_history(archive);
}

}  // namespace

std::size_t state_size(Wheel& w) {
  support::Archive archive = support::Archive::counting();
  write(w, archive);
  return sizeof(Header) + archive.bytes();
}

void save_state(Wheel& w, unsigned char* bytes) {
  support::Archive archive = support::Archive::writing(bytes + sizeof(Header));
  write(w, archive);
  const std::size_t size = archive.bytes();
  const Header header = {mark_of(w.demand.kind), sizeof header + size,
                         support::checksum_of(bytes + sizeof header, size)};
  std::memcpy(bytes, &header, sizeof header);
}

const char* fault_of(Kind kind, const unsigned char* bytes, std::size_t size) {
  Header header;
  if (size < sizeof header) return "the bytes are too few";
  std::memcpy(&header, bytes, sizeof header);
  if (header.mark != mark_of(kind)) return "the bytes are no state of this FMU, its version and kind of instance";
  const std::uint64_t checksum = support::checksum_of(bytes + sizeof header, size - sizeof header);
  return header.size == size && header.checksum == checksum ? nullptr : "the bytes are damaged";
}

const char* load_state(Wheel& w, const unsigned char* bytes, std::size_t size) {
  if (const char* fault = fault_of(w.demand.kind, bytes, size)) return fault;
  support::Archive archive = support::Archive::reading(bytes + sizeof(Header), size - sizeof(Header));
  Record record(w.demand.kind);
  visit(archive, record);
  const bool stepping = record.run.phase == Phase::stepping;
  if (!archive.fits() || !complete(record) || (!stepping && !archive.is_sound())) return forged;
  static_cast<Record&>(w) = record;
  w.orbit.leave();
  if (!stepping || w.solver.restore_history(problem_of(w), method_of(w.setup, w.run.in_force), archive)) return nullptr;
  w.run.phase = Phase::broken;
  return forged;
}

}  // namespace wheel
