// One free wheel and its orbit behind a C interface, for ctypes. State and units as in wheel_equations.h.
#include <algorithm>
#include <new>

#include "law.hpp"
#include "motion.hpp"
#include "posed_problem.hpp"
#include "setting.hpp"

#ifdef _WIN32
#define PUBLIC extern "C" __declspec(dllexport)
#else
#define PUBLIC extern "C" __attribute__((visibility("default")))
#endif

namespace {

struct Probe {
  wheel::Reporter reporter;
  wheel::Wheel wheel{reporter, wheel::Kind::co_simulation};
  solver::Solver& solver = wheel.solver;
  orbit::Orbit& orbit = wheel.orbit;
  double builds = 0;
};

double force(const Probe& probe, const double* y) {
  const WheelScene scene = probe.wheel.run.in_force.scene_at(0);
  double y_dot[8];
  return wheel_reduced.derivative(&scene, y, y_dot);
}

// What Python adds to the rate of the state at `place`, or beyond the last to what is watched for an event: no wheel
// with such a force or such a limit may be unfolded.
using Added = double (*)(double t, const double* y);
Added added = nullptr;
double size = 0;
int place = 0;
decltype(solver::Problem::derivative) rates_of_wheel = nullptr;
decltype(solver::Watched::value) value_of_wheel = nullptr;

double disturbed(void* owner, double t, const double* y, double* y_dot) {
  const double margin = rates_of_wheel(owner, t, y, y_dot);
  y_dot[place] += size * added(t, y);
  return margin;
}

double other_limit(void* owner, int event, double t, const double* y) {
  return value_of_wheel(owner, event, t, y) + size * added(t, y);
}

void disturb(solver::Problem& problem) {
  rates_of_wheel = problem.derivative;
  value_of_wheel = problem.watched[0].value;  // one function for all events
  if (place < problem.states)
    problem.derivative = disturbed;
  else
    for (solver::Watched& watched : problem.watched) watched.value = other_limit;
}

}  // namespace

// A wheel with these parameters, by value reference.
PUBLIC Probe* probe_make(const unsigned* references, const double* values, int count, double tolerance) {
  Probe* probe = new (std::nothrow) Probe;
  if (!probe) return nullptr;
  wheel::Wheel& wheel = probe->wheel;
  for (int i = 0; i < count; ++i) wheel.demand.parameters[references[i]] = values[i];
  wheel.demand.tolerance = tolerance;
  wheel.setup = wheel::setup_of(wheel.demand, false);
  wheel::enforce(wheel.setup, wheel.demand, 0, wheel.setup.initial_state, wheel.run.in_force);
  return probe;
}

PUBLIC void probe_free(Probe* probe) { delete probe; }

// Place in KINDS of unfolded.py. `by`: a disturbance, or null.
PUBLIC int probe_build(Probe* probe, int at, double so_much, Added by) {
  wheel::Record ahead = static_cast<const wheel::Record&>(probe->wheel);
  solver::Problem problem = wheel::problem_of(ahead);
  place = at, size = so_much, added = by;
  if (added) disturb(problem);
  const wheel::Setup& setup = probe->wheel.setup;
  const double build = ++probe->builds;  // each is another motion
  const orbit::FreeMotion motion = {
      problem,       setup.tolerance, setup.time_scale, wheel::follow_on_orbit, setup.initial_state,
      solver::never, {&build, 1}};
  if (!probe->orbit.enter(motion, probe->solver)) return 0;
  const orbit::Course& course = probe->orbit.course();
  return course.ending ? 3 : std::holds_alternative<orbit::Circle>(course.path) ? 2 : 1;
}

// States at `count` instants, 8 numbers each, psi, phi, X_O and Y_O whole; and N.
PUBLIC void probe_read(Probe* probe, const double* t, int count, double* y, double* N) {
  for (int i = 0; i < count; ++i) {
    double* const state = y + 8 * i;
    probe->orbit.read(t[i], state);
    N[i] = force(*probe, state);
    const wheel::Setup& setup = probe->wheel.setup;
    const wheel::Origin* const origins[] = {&setup.psi, &setup.phi, &setup.X_O, &setup.Y_O};
    for (int k = 0; k < 4; ++k) state[4 + k] = origins[k]->whole(state[4 + k]);
  }
}

// The state at t of a new run of the wheel, with another value of a parameter; and the steps that the solver took for
// it, negative where the run failed.
PUBLIC long long probe_run(Probe* probe, unsigned reference, double value, double t, double* y) {
  wheel::Wheel& wheel = probe->wheel;
  wheel.demand.parameters[reference] = value;
  const bool sound =
      wheel::end_initialization(wheel) &&
      probe->solver.start(wheel::problem_of(wheel), solver::Method::runge_kutta, 0, wheel.setup.initial_state);
  if (!sound || wheel::advance(wheel, t) != wheel::Progress::done) return -1;
  wheel::update_state(wheel);
  std::copy_n(wheel.run.y(), 8, y);
  return probe->solver.counters().steps;
}

PUBLIC double probe_half_period(Probe* probe) {
  return probe->orbit.until() >= 0 ? probe->orbit.course().half_period() : 0;
}
// Of N, the only event after which the motion goes on.
PUBLIC double probe_first_fall(Probe* probe) {
  return probe->orbit.course().first_times[static_cast<int>(wheel::Event::lost_contact)];
}
PUBLIC long long probe_steps(Probe* probe) { return probe->solver.counters().steps; }
