// One wheel, and its run from the parameters to the end. A wheel has what the caller has set, what follows from it,
// what is in force, how far the run has come, and the solution as far as it is known. The run has a clock, which is
// zero at the start, so that a start time of 1e9 s costs no digits.
//
// Of a wheel that is passed as const, a function changes only what is kept to save work: the polynomial of a step, the
// piece of a track and the half of an orbit that were read last. So no two threads may read one wheel. A function that
// takes a Record that is not const changes that, but never the solution.
//
// The other headers of this folder, each below those that it includes:
//   reporter, variables, inputs   messages; the table of the variables; inputs as polynomials of time
//   setup, in_force, run          what follows from the parameters; what acts on the wheel; how far the run has come
//   law, events                   how the mode of rolling and the contact are decided; the table of what can happen
//   logbook, transitions          messages; events that a run passes, changes of mode and contact, its end
//   posed_problem                 what the solver asks
//   motion, exchange, setting     one communication step; model exchange; what the caller sets, and initialization
//   slopes, quotients, snapshot   derivatives of the variables, by difference quotients; the state as bytes
//
// Words for the way from what is asked for to what is in force:
//   set                      the caller's value stands in the demand; a reading shows it (Pending)
//   enforce                  the demand is in force from an instant on: take_over, then a jump of the carrier, contact
//                            and mode
//     prepare                at the start
//     in_force_now           on a copy, for a reading
//     apply_demand           at the next step of co-simulation
//     take_by_setting        for a derivative by a rate of the carrier, on a copy (slopes.cpp)
//   act_at_once              model exchange: take_over alone; the mode waits for event mode, or follows at once if the
//                            road has changed
//   follow_event             what follows from an event is in force
//     pass_event             for the run, counted and logged
//     follow_on_orbit        ahead of the run
//     catch_up_with_orbit    afterwards, of events that are only observed
#pragma once

#include <optional>

#include "orbit.hpp"
#include "run.hpp"

namespace wheel {

// All that a saved state restores of a wheel but its solution: numbers that are copied and restored by assignment.
struct Record {
  explicit Record(Kind kind) : demand(kind) {}

  Demand demand;
  Setup setup = {};  // of the demand, from the first state on
  Run run;

  double time() const { return demand.start_time + run.t; }  // the caller's
  bool has_ended() const { return run.ended_by != Event::none; }
};

// Whether what is in force differs from the demand, by more than the rounding of its polynomials.
bool differs_from_demand(const Record& record);
// Whether something was set since the last step that makes a difference: a reading shows it, and a step puts it in
// force.
inline bool takes_effect(const Record& record) {
  return record.run.pending == Pending::set && differs_from_demand(record);
}
// (y: the state at the instant reached) => what is in force for what follows, with what was set since the last step. y
// changes where a slip begins or ends, or the carrier jumps.
InForce in_force_now(const Record& record, double* y);
// (y: the state at the instant reached) => which observed events lie below zero. A run on an orbit does not follow
// them.
void catch_up_with_orbit(const Record& record, const double* y, InForce& in_force);

struct Wheel;

// A wheel at one instant. Fixed axes.
struct Instant {
  // (y: the state at the instant reached) => that instant, where what was set since the last step is in force at once.
  // The record stays where it is as long as the instant is in use.
  Instant(const Record& record, const double* y);

  const Setup* setup;
  WheelScene scene;  // for what follows the instant, with the ground by the sign of N
  double y[max_states];
  double x[WHEEL_EULER_STATES];  // model exchange: the states, from which y follows
  solver::Counters counters;     // without those of the solver at work, which instant_of adds
  long long transitions;
};

// All that can be read at one instant, which does not change. Positions and velocities are computed when they are first
// asked for, and kept; so are accelerations and reactions. Nothing is computed for an output that nobody reads.
class Reading {
 public:
  explicit Reading(const Instant& of) : at(of) {}
  explicit Reading(const Wheel& wheel);  // of the instant reached

  const Instant at;

  // psi, phi, X_O and Y_O as the state counts them.
  const WheelKinematics& kinematics() {
    if (kinematics_) return *kinematics_;
    WheelKinematics& k = kinematics_.emplace();
    at.setup->model_exchange ? wheel_euler_kinematics(&at.scene.wheel, at.x, &k)
                             : formulation_of(*at.setup, at.scene.contact).kinematics(&at.scene.wheel, at.y, &k);
    return k;
  }
  const WheelDynamics& dynamics() {
    if (!dynamics_) dynamics_ = dynamics_of(*at.setup, at.scene, at.y);
    return *dynamics_;
  }
  // X_C and Y_C as the state counts X_O and Y_O.
  WheelContact contact() { return wheel_contact(&at.scene.wheel, &kinematics()); }

 private:
  std::optional<WheelKinematics> kinematics_ = {};
  std::optional<WheelDynamics> dynamics_ = {};
};

struct Wheel : Record {
  Wheel(const Reporter& to, Kind kind) : Record(kind), reporter(to) {}

  const Reporter& reporter;
  // The solution: steps of the solver, or the orbit of a wheel that is unfolded.
  solver::Solver solver;
  orbit::Orbit orbit;
  long long endings = 0;  // of all runs since the last reset, logged or not, even if the caller went back before them
};

// Whether the variable is a rate of a wheel carrier.
inline bool is_guide_rate(unsigned variable) { return variable >= variable::psi_dot_guide && variable < stored_count; }
// Whether it is such a rate, and no carrier turns the running wheel.
inline bool is_idle(const Record& record, unsigned variable) {
  return is_guide_rate(variable) && is_running(record.run.phase) && !record.setup.steered;
}

// The state at the instant reached, from the solution.
void read_state(const Wheel& wheel, double* y);
inline void update_state(Wheel& wheel) {
  if (!wheel.run.lags()) return;
  double y[max_states];
  read_state(wheel, y);
  wheel.run.set_y(y);
}

Instant instant_of(const Wheel& wheel);

}  // namespace wheel
