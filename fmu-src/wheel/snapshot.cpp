// Bytes may come from anywhere: each number is checked before it is used.
#include "snapshot.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "bytes.hpp"
#include "events.hpp"
#include "exchange.hpp"
#include "law.hpp"
#include "motion.hpp"
#include "problem.hpp"

namespace wheel {
namespace {

// Of this FMU and version: its GUID, which follows from the description.
constexpr std::uint64_t mark = [] {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const char letter : WHEEL_GUID) hash = (hash ^ static_cast<unsigned char>(letter)) * 0x100000001b3u;
  return hash;
}();

struct Header {
  std::uint64_t mark, size, checksum;
};

// The table of what is saved: what the caller has set, and what of the run does not follow from it. A row names the
// field and gives its kind and its bounds.
void visit(support::Archive& archive, Demand& demand, Run& run) {
  InForce& now = run.in_force;
  archive("parameters as they were set, those asked for among them");
  for (double& parameter : demand.parameters) archive.anything(parameter);
  archive("start time, s").number(demand.start_time);
  archive("stop time, s; infinite for none").range(demand.stop_time, -archive.greatest, Demand::never);
  archive("tolerance").range(demand.tolerance, tightest_tolerance, loosest_tolerance);
  archive("inputs asked for, with their derivatives");
  for (auto& input : demand.inputs) {
    archive.anything(input[0]);
    archive.numbers(input + 1, max_order);
  }
  archive("whose solver moves the wheel").count(demand.kind, 0, 1);
  archive("something was set since the last step").count(demand.changed, 0, 1);
  archive("phase").count(run.phase, 0, phase_count - 1);
  archive("event that ended the model").count(run.ended_by, 0, event_count - 1);
  archive("s in force, m").range(now.road.s, 0, archive.greatest);
  archive("mu_max in force").range(now.road.mu_max, 0, archive.greatest);
  archive("mu_slide in force").range(now.road.mu_slide, 0, archive.greatest);
  archive("slope in force, rad").range(now.road.slope, 0, upright);
  archive("direction of the slope in force, rad").number(now.road.slope_direction);
  archive("kind of the law of friction").count(now.scene.friction.kind, WHEEL_NO_LAW, WHEEL_REGULARIZED);
  archive("sign of omega_z in the law of friction").range(now.scene.friction.sigma, -1, 1);
  archive("place in the layer of a stiff law").count(now.layer, 0, static_cast<int>(Layer::sticking));
  archive("contact with the ground").count(now.scene.contact, WHEEL_GRIPS, WHEEL_SLIDES);
  archive("origin of the inputs in force, s").number(now.inputs.origin);
  archive("inputs in force");
  for (auto& input : now.inputs.c) archive.numbers(input, max_order + 1);
  archive("time reached, s").number(run.t);
  archive("time of the last change, s").range(run.last_change, 0, archive.greatest);
  archive("when mu_required is looked at, s; infinite for never").range(run.grip_due, 0, Demand::never);
  archive("state").numbers(run.y, WHEEL_MAX_STATES);
  for (int i = 0; i < event_count; ++i) {
    archive("whether an observed event lies below zero").count(now.below[i], 0, 1);
    archive("occurrences of an observed event").tally(run.tallies[i].count);
    archive("time of its last occurrence, s").number(run.tallies[i].last);
  }
  archive("transitions of the friction").tally(run.transitions);
  archive("counts before the solver was started");
  for (long long* count : run.counted.all()) archive.tally(*count);
}

// Whether the law is one that put_in_force could have chosen.
bool law_fits(const Setup& setup, const InForce& now) {
  const bool exact = setup.friction_law == exact_law, outside = now.layer == Layer::outside;
  const bool waits = setup.kind == Kind::model_exchange;  // the law waits for the next event
  const bool none = now.scene.wheel.s == 0 && !now.inputs.braked, some = waits || !none;
  if (now.layer != Layer::none && (none || waits || exact || setup.method != automatic_method)) return false;
  const WheelFriction& law = now.scene.friction;
  if (law.kind == WHEEL_FRICTIONLESS) return none || waits;
  if (law.kind == WHEEL_REGULARIZED) return some && !exact && !outside;
  if (law.kind == WHEEL_ROLLING) return some && exact != outside && std::fabs(law.sigma) == 1;
  return law.kind == WHEEL_HELD && some && exact;
}

// Whether the run has ended by an event exactly where its phase says so.
bool end_fits(const Setup& setup, const Run& run) {
  const bool over = run.phase == Phase::ended || run.phase == Phase::closed;
  if (run.ended_by == Event::none) return run.phase != Phase::ended;
  const EventRow& row = row_of(run.ended_by);
  constexpr double rounding = 1e-3;  // of a margin, where an instant has been found
  return over && ends_run(row, setup) && row.can_occur(setup, run.in_force) &&
         (has_occurred(row, setup, run) || margin_of(row, setup, run.in_force, run.t, run.y) < rounding);
}

// Events that are observed, and no others, may lie below zero and be counted.
bool observed_fit(const Setup& setup, const Run& run) {
  for (int i = 0; i < event_count; ++i) {
    const bool observed = i > 0 && is_observed(row_of(static_cast<Event>(i)), setup);
    if (!observed && (run.in_force.below[i] || run.tallies[i].count != 0)) return false;
  }
  return true;
}

// Whether the state is that of the start, with the slip that follows from what is in force.
bool starts_there(const Setup& setup, const Run& run) {
  double y[WHEEL_MAX_STATES];
  std::copy_n(setup.start, WHEEL_MAX_STATES, y);
  InForce now = run.in_force;
  now.scene.contact = setup.starts_sliding ? WHEEL_SLIDES : WHEEL_GRIPS;
  if (setup.sliding) decide_contact(setup, 0, y, now);
  return std::equal(y, y + WHEEL_MAX_STATES, run.y);
}

// Completes a run that was read by what follows from its demand. Null where a run can have been in this state, else
// what is wrong with it.
const char* complete(const Demand& demand, Setup& setup, Run& run) {
  if (run.phase == Phase::faulty) run.phase = Phase::initializing;  // the faults are logged again
  if (!has_state(run.phase)) return run.ended_by == Event::none ? nullptr : "no such event ends a run";
  if (!check_values(demand, Reporter(), false)) return "parameters and inputs describe no wheel";
  setup = setup_of(demand);
  run.y_time = run.t;
  InForce& now = run.in_force;
  let_act(setup, Road(now.road), now.inputs.origin, Inputs(now.inputs).c, now);
  now.scene.friction.omega_s = now.scene.friction.kind == WHEEL_REGULARIZED ? setup.omega_s : 0;
  now.set_below(Event::lost_contact, now.pulls());
  if (now.slides() && !setup.sliding) return "the wheel slides without mu_slide";
  if (!end_fits(setup, run)) return "no such event ends a run";
  if (!law_fits(setup, now)) return "the law of friction does not fit s and the brake";
  if (!observed_fit(setup, run)) return "an event is counted that cannot be observed";
  if (run.phase == Phase::unfolded && !is_unfoldable(setup, now)) return "what acts cannot be unfolded";
  const bool goes_back = demand.kind == Kind::model_exchange;  // the caller's solver takes trial steps back
  if (!goes_back && (run.last_change > run.t || now.inputs.origin > run.t))
    return "a change lies ahead of the time reached";
  const bool exchanged = run.phase == Phase::event_mode || run.phase == Phase::continuous_time;
  const bool stepped = run.phase == Phase::at_start || run.phase == Phase::stepping || run.phase == Phase::unfolded;
  if (demand.kind == Kind::model_exchange ? stepped : exchanged) return "the phase is one of the other kind of run";
  const bool at_start = run.phase == Phase::initial || run.phase == Phase::at_start;
  if (at_start && !(run.t == 0 && starts_there(setup, run))) return "a run that has not begun stands at its start";
  return nullptr;
}

void write(Wheel& w, support::Archive& archive) {
  visit(archive, w.demand, w.run);
  if (w.run.phase == Phase::stepping) w.solution.solver.save_history(archive);
}

}  // namespace

std::size_t state_size(Wheel& w) {
  support::Archive archive = support::Archive::counting();
  write(w, archive);
  return sizeof(Header) + archive.bytes();
}

void save_state(Wheel& w, unsigned char* bytes) {
  if (has_state(w.run.phase)) state_now(w);
  support::Archive archive = support::Archive::writing(bytes + sizeof(Header));
  write(w, archive);
  const std::size_t size = archive.bytes();
  const Header header = {mark, sizeof header + size, support::checksum_of(bytes + sizeof header, size)};
  std::memcpy(bytes, &header, sizeof header);
}

const char* load_state(Wheel& w, const unsigned char* bytes, std::size_t size, bool foreign) {
  Header header;
  if (size < sizeof header) return "they are too few";
  std::memcpy(&header, bytes, sizeof header);
  const unsigned char* fields = bytes + sizeof header;
  support::Archive archive = support::Archive::reading(fields, size - sizeof header);
  if (header.mark != mark) return "the mark of this version is missing";
  if (header.size != size) return "the size is another";
  if (support::checksum_of(fields, size - sizeof header) != header.checksum) return "the checksum is wrong";
  Demand demand;
  Setup setup = {};
  Run run;
  visit(archive, demand, run);
  if (archive.fault()) return archive.fault();
  if (const char* fault = complete(demand, setup, run)) return fault;
  Reading reading;
  reading.set({&setup, run.y, run.in_force.scene_at(run.t), nullptr});
  if (foreign && has_state(run.phase) && !is_inside(reading)) return "the state is outside the model";
  if (demand.kind != w.demand.kind) return "they belong to an instance of the other kind";
  if (run.phase != Phase::stepping && !archive.is_sound()) return "bytes are left over";
  w.demand = demand;
  w.setup = setup;
  w.run = run;
  w.solution.orbit_until = Solution::none;
  solver::Solver& solver = w.solution.solver;
  if (run.phase != Phase::stepping ||
      (solver.restore_history(problem_of(w), archive) && solver.step_start() <= run.t && solver.reaches(run.t)))
    return nullptr;
  w.run.phase = Phase::failed;
  return "the history of the solver could not be restored";
}

}  // namespace wheel
