// A run from its parameters to its initial state, and what is read of it.
#include "simulation.hpp"

#include <algorithm>
#include <cmath>
#include <cstdarg>

namespace wheel {

void Reporter::print(Topic topic, const char* format, ...) const {
  char message[longest];
  std::va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(message, sizeof message, format, arguments);
  va_end(arguments);
  take(owner, topic, message);
}

void Simulation::reset() {
  demand_.change() = Demand(kind());
  run_.change() = Run();
}

void Simulation::set_experiment(double start_time, double stop_time, double tolerance) {
  const double taken = tolerance > 0 ? std::clamp(tolerance, tightest_tolerance, loosest_tolerance) : default_tolerance;
  Demand& demand = demand_.change();
  demand.start_time = start_time;
  demand.stop_time = stop_time;
  demand.tolerance = taken;
  if (tolerance > 0 && tolerance != taken)
    reporter_.log(Topic::warning, "The tolerance %s is outside [%s, %s]; %s is used.", Digits{tolerance, 6},
                  Digits{tightest_tolerance, 6}, Digits{loosest_tolerance, 6}, Digits{taken, 6});
}

void Simulation::set(unsigned variable, double value, int order) {
  if (variable >= stored_count) {
    Run& run = run_.change();
    run.y[state_index_of(variable)] = value;
    return decide_law(setup_, run.t, run.y, run.in_force);
  }
  if (phase() == Phase::faulty || phase() == Phase::initial) enter(Phase::initializing);
  if (demand_->value(variable, order) == value / factorial[order]) return;
  Demand& demand = demand_.change();
  demand.value(variable, order) = value / factorial[order];
  demand.changed = true;
  if (kind() == Kind::model_exchange && is_running(phase())) take_at_once(setup_, demand, run_.change());
}

bool Simulation::prepare(bool report) {
  const Reporter reporter = report ? reporter_ : Reporter();
  Run& run = run_.change();
  run = Run();
  run.phase = Phase::faulty;
  solution_.orbit_until = Solution::none;
  if (!check_values(*demand_, reporter)) return false;
  setup_ = setup_of(*demand_);
  put_in_force(setup_, *demand_, 0, setup_.start, run.in_force);
  std::copy_n(setup_.start, setup_.formulation->states, run.y);
  demand_.change().changed = false;
  if (check_start(*demand_, reading(), reporter)) run.phase = Phase::initial;
  return phase() == Phase::initial;
}

bool Simulation::start() {
  const bool exchanged = kind() == Kind::model_exchange;
  const bool sound = prepare() && (!exchanged || starts_inside(setup_, *run_, reporter_));
  enter(!sound ? Phase::without_start : exchanged ? Phase::event_mode : Phase::at_start);
  return sound;
}

void Simulation::close() {
  if (phase() != Phase::ended) log_summaries(setup_, *run_, reporter_);
  freeze(run_.change(), solution_, Phase::closed);
}

solver::Outcome Simulation::advance(double t) {
  return wheel::advance(setup_, demand_.change(), run_.change(), solution_, reporter_, t - demand_->start_time);
}

void Simulation::set_time(double t) {
  Run& run = run_.change();
  run.t = run.y_time = t - demand_->start_time;
}

// With what was set since the last step.
InForce Simulation::in_force_now() const {
  InForce now = run_->in_force;
  if (demand_->changed) put_in_force(setup_, *demand_, run_->t, run_->y, now);
  return now;
}

// Where nothing was set, without a copy of all that is in force.
Present Simulation::present() {
  state_now(run_.change(), solution_);
  Present now = {
      setup_.formulation, run_->y, demand_->changed ? in_force_now().scene : run_->in_force.scene_at(run_->t),
      &demand_->inputs,   &*run_,  &solution_};
  now.scene.ground = WHEEL_GROUND_BY_FORCE;
  return now;
}

Reading& Simulation::read() {
  const Present now = present();
  reading_.set(now, version());
  return reading_;
}

// The same as it answers a change of one known: a brake that is not in use has the law that it would have in use. In
// model exchange that law waits for an event.
Present Simulation::present_for(unsigned known) {
  Present now = present();
  const bool brake = known == first_input + brake_input && kind() == Kind::co_simulation;
  if (!brake || now.scene.friction.kind != WHEEL_FRICTIONLESS) return now;
  InForce used = in_force_now();
  used.inputs.braked = true;
  decide_law(setup_, run_->t, now.y, used);
  now.scene.friction = used.scene.friction;
  return now;
}

namespace {

// Of a derivative from differences: f at four places, in steps from x, and their weights, exact for polynomials of
// degree four: about x, or to one side where a limit is near.
struct Stencil {
  int places[4];
  double weights[4];
};
constexpr Stencil stencils[] = {{{-2, -1, 1, 2}, {1.0 / 12, -8.0 / 12, 8.0 / 12, -1.0 / 12}},
                                {{1, 2, 3, 4}, {4, -3, 4.0 / 3, -1.0 / 4}},
                                {{-1, -2, -3, -4}, {-4, 3, -4.0 / 3, 1.0 / 4}}};

// Differences from the value at x itself, so that a function that does not depend on x has the derivative zero. None
// where f has no value.
template <class Function>
std::optional<double> difference_quotient(const Stencil& stencil, double x, double h, Function f) {
  const std::optional<double> centre = f(x);
  double sum = 0;
  for (int k = 0; k < 4; ++k) {
    const std::optional<double> value = f(x + stencil.places[k] * h);
    if (!value || !centre) return {};
    sum += stencil.weights[k] * (*value - *centre);
  }
  return sum / h;
}

}  // namespace

// Of co-simulation's outputs only the reactions depend on the inputs of the same instant.
std::optional<double> Simulation::derivative(unsigned unknown, unsigned known) {
  if (known < first_input) return start_derivative(unknown, known);
  const Row& row = row_of(unknown);
  const bool exchanged = kind() == Kind::model_exchange && has_begun(phase());
  if (exchanged || (!row.reaction_rate && row.role == Role::local)) return partial(unknown, known);
  if (!row.reaction_rate) return 0;
  WheelLoad unit = {};
  *load_entry(unit, static_cast<int>(known - first_input)) = 1;
  Reading answer;
  answer.set(present_for(known));
  return row.reaction_rate(answer.response(unit));
}

// In the initial state; an integer or boolean parameter moves nothing. Afterwards the initial state is the present one
// again. The step is relative to the parameter where it cannot be negative; for an angle, a place or a rate it is
// relative to the parameter or to 1, whichever is larger.
std::optional<double> Simulation::start_derivative(unsigned unknown, unsigned parameter) {
  const Row& row = row_of(parameter);
  if (row.type != Type::real) return 0;
  const double x = demand_->value(parameter), size = std::fabs(x);
  const double scale = row.min == 0 && x != 0 ? size : std::fmax(size, 1);
  const auto value_at = [&](double near_x) {
    set(parameter, near_x);
    return prepare(false) ? std::optional(value(unknown)) : std::nullopt;
  };
  std::optional<double> slope;
  for (const double share : {1e-3, 1e-6, 1e-9})
    for (const Stencil& stencil : stencils)
      if (!slope) slope = difference_quotient(stencil, x, share * scale, value_at);
  return value_at(x) ? slope : std::nullopt;
}

// The law and the sign of N are kept. Steps are small parts of what each known turns on, those of a load of the whole
// weight or of the load: all but mu_required is linear in it.
std::optional<double> Simulation::partial(unsigned unknown, unsigned known) {
  double y[WHEEL_MAX_STATES], scales[WHEEL_MAX_STATES];
  Present now = present_for(known);
  std::copy_n(now.y, WHEEL_MAX_STATES, y);
  scales_at(setup_, 0, scales);
  now.y = y;
  now.scene.ground = reading().dynamics().lambda[2] > 0 ? WHEEL_GROUND_PRESSES : WHEEL_GROUND_PULLS;
  const int state = kind() == Kind::model_exchange ? state_index_of(known) : -1;
  double& place = state >= 0 ? y[state] : *load_entry(now.scene.load, static_cast<int>(known - first_input));
  double h = state >= 0 ? scales[state] : std::fmax(setup_.whole_weight, std::fabs(place));
  if (state == setup_.formulation->tilt_index) h *= std::sin(place);
  const bool soft = state == setup_.formulation->spin_index && now.scene.friction.kind == WHEEL_REGULARIZED;
  Reading reading;
  const auto value_at = [&](double x) -> std::optional<double> {
    place = x;
    reading.set(now);
    return row_of(unknown).read(reading);
  };
  return difference_quotient(stencils[0], place, 1e-3 * (soft ? std::fmin(h, setup_.omega_s) : h), value_at);
}

}  // namespace wheel
