// Parameters, inputs and states as the caller sets them, and the initial state.
#include "setting.hpp"

#include <algorithm>

#include "events.hpp"
#include "exchange.hpp"
#include "law.hpp"
#include "logbook.hpp"
#include "transitions.hpp"

namespace wheel {
namespace {

// Whether the initial state is inside the model; if not, a message is logged. No force of the ground holds a wheel that
// jams, and values that are sound one by one can have products that are not finite.
bool check_start(const Record& r, Reading& start, const Reporter& reporter) {
  const InForce& in_force = r.run.in_force;
  if (in_force.slides() && margin_of(event_row(Event::jams), r.setup, in_force, 0, r.run.y()) < 0)
    return reporter.check(false, "At the start the wheel %s: the run ends there.",
                          ending_of(in_force, Event::jams).text);
  double sum = row_of(variable::E).read(start) + start.dynamics().tau;
  for (const double force : start.dynamics().lambda) sum += force;
  const auto set = [&](variable::Place v) { return Digits{r.demand.parameters[v], 3}; };
  return reporter.check(std::isfinite(sum),
                        "The initial energy or reaction force overflows: m = %s kg, J_z = %s kg m2, r_0 = %s m, "
                        "g = %s m/s2, omega_z = %s rad/s.",
                        set(variable::m), set(variable::J_z), set(variable::r_0), set(variable::g),
                        Digits{start.kinematics().omega_z, 3});
}

// Once, at the end of the initialization.
void warn_of_paper_start(const Wheel& w) {
  const double* v = w.demand.parameters;
  const auto unset = [&](unsigned parameter) { return v[parameter] == row_of(parameter).start; };
  if (v[variable::guided] != 0 && unset(variable::psi_start) && unset(variable::theta_start))
    w.reporter.log(Topic::warning,
                   "The guided wheel keeps the paper's psi_start and theta_start: it heads along Y, and its axle is 15 "
                   "degrees off the road's plane; a vehicle's wheel has psi_start = 0 and theta_start = pi/2.");
}

}  // namespace

void reset(Wheel& w) {
  static_cast<Record&>(w) = Record(w.demand.kind);
  w.endings = 0;
}

void set_experiment(Wheel& w, double start_time, double stop_time, double tolerance) {
  const double taken = tolerance > 0 ? std::clamp(tolerance, tightest_tolerance, loosest_tolerance) : default_tolerance;
  w.demand.start_time = start_time;
  w.demand.stop_time = stop_time;
  w.demand.tolerance = taken;
  if (tolerance > 0 && tolerance != taken)
    w.reporter.log(Topic::warning, "The tolerance %s is outside [%s, %s]; %s is used.", Digits{tolerance, 6},
                   Digits{tightest_tolerance, 6}, Digits{loosest_tolerance, 6}, Digits{taken, 6});
}

void set(Wheel& w, unsigned variable, double value, int order) {
  if (variable >= stored_count) return impose_state(w, variable, value);
  Run& run = w.run;
  if (run.phase == Phase::faulty || run.phase == Phase::initial) run.phase = Phase::initializing;
  double& asked = w.demand.value(variable, order);
  const double taken = value / factorial[order];
  if (asked == taken && run.pending != Pending::ended_derivatives)
    return;  // whatever is set ends those of the last step
  asked = taken;
  run.pending = Pending::set;
  if (w.demand.kind == Kind::model_exchange && is_running(run.phase)) act_at_once(w);
}

void begin_initialization(Wheel& w) { w.run.phase = Phase::initializing; }

bool prepare(Record& r, const Reporter& reporter) {
  Run& run = r.run;
  run = Run();
  run.phase = Phase::faulty;
  run.can_slide = r.demand.parameters[variable::mu_slide] > 0;
  if (!check_values(r.demand, run.can_slide, Checked::at_start, reporter)) return false;
  r.setup = setup_of(r.demand, run.can_slide);
  std::copy_n(r.setup.initial_state, max_states, run.y());
  run.in_force = InForce(r.setup);
  if (r.setup.steered) start_guide_rates(r.setup, r.demand, run.y());
  enforce(r.setup, r.demand, 0, run.y(), run.in_force);
  if (r.setup.model_exchange) {
    double x[WHEEL_EULER_STATES];
    wheel_euler_states(run.y(), r.demand.parameters[variable::psi_dot_start], x);
    run.set_x(x);
  }
  Reading start(Instant(r, run.y()));
  if (check_start(r, start, reporter)) run.phase = Phase::initial;
  return run.phase == Phase::initial;
}

bool prepare_once(Wheel& w) {
  if (w.run.phase == Phase::faulty) return false;
  return w.run.phase != Phase::initializing || prepare(w, w.reporter);
}

bool end_initialization(Wheel& w) {
  const bool exchange = w.demand.kind == Kind::model_exchange;
  const bool sound = prepare(w, w.reporter) && (!exchange || starts_inside(w));
  if (sound) {
    warn_of_paper_start(w);
    note_changes(w, InForce(w.setup));
  }
  w.run.phase = !sound ? Phase::without_start : exchange ? Phase::event_mode : Phase::at_start;
  return sound;
}

}  // namespace wheel
