// One wheel in motion: what the caller demands, the setup decided once, the run, and its solution step by step.
//
// Knows no FMI. Times are the caller's; the solver runs on its own clock, zero at the start, so that a start time of
// 1e9 s costs no digits. Messages go to the Reporter as finished sentences.
#pragma once

#include <array>
#include <cstddef>

#include "motion.hpp"
#include "orbit.hpp"
#include "reading.hpp"
#include "reporter.hpp"
#include "solver.hpp"
#include "variables.hpp"

namespace wheel {

// Of model exchange.
inline constexpr int state_count = WHEEL_REDUCED_STATES, indicator_count = 3;
// The place of a variable among the states, or -1.
int state_of(unsigned variable);

class Simulation {
 public:
  Simulation(const Reporter& reporter, Kind kind) : reporter_(reporter) { demand_.kind = kind; }
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  // As new: start values, nothing computed.
  void reset();
  // What the caller begins: initialization, or a mode of model exchange.
  void enter(Phase phase) { run_.phase = phase; }
  // The end of initialization: false if there is no initial state.
  bool start();
  // The caller ends the run.
  void close();
  Phase phase() const { return run_.phase; }
  Kind kind() const { return demand_.kind; }

  // stop_time: infinite for none. tolerance <= 0: the default one.
  void set_experiment(double start_time, double stop_time, double tolerance);

  // Parameters and inputs: variables below stored_count. Values are checked as a whole by prepare.
  void store(unsigned variable, double value);
  void set_input_derivative(unsigned variable, int order, double value);

  // Before the end of the initialization: the initial state from the present parameters, true if it exists. Else one
  // sentence per fault through the Reporter.
  bool prepare(bool report = true);

  // To the caller's time t. `stepped`: it was reached; `event`: the model ended at time(); `failed`: the state is that
  // before the call.
  solver::Outcome advance(double t);

  double time() const { return demand_.start_time + run_.t; }
  double stop_time() const { return demand_.stop_time; }
  // What ended the model, to stand behind "the wheel"; null while nothing has.
  const char* ending() const { return ending_of(run_.ended_by); }
  // The value of a variable now; inputs just set take effect at once.
  double value(unsigned variable);
  // Its time derivative, for outputs.
  double rate(unsigned variable);
  // d unknown / d known at this instant, of a calculated variable by an input, during a run in model exchange by a
  // state too; zero for what depends on inputs only through time.
  double sensitivity(unsigned unknown, unsigned known);

  // Model exchange (exchange.cpp): x are the state_count states of wheel_euler; derivatives and indicators are false
  // where they are not finite. An event mode decides the law of friction and whether the model ends: true where it
  // changed a state.
  void set_time(double t);
  void set_states(const double* x);
  void set_state(int index, double value);
  const double* states() { return y_now(); }
  void nominals(double* x) const;
  bool derivatives(double* x_dot);
  bool indicators(double* z);
  bool has_event();
  bool decide();

  // Demand, run and the solver's history as portable bytes with a checksum. load_state returns null, or why the bytes
  // could not have been saved: everything is then as it was, unless it is the solver's history that is wrong.
  // foreign: they come from outside of this library, so the state itself is judged too.
  std::size_t state_size();
  void save_state(unsigned char* bytes);
  const char* load_state(const unsigned char* bytes, std::size_t size, bool foreign);

 private:
  bool check_start(const Reporter& reporter);
  void write(support::Archive& archive);

  const double* y_now();
  void freeze(Phase phase);
  solver::Counters counters() const;
  WheelScene scene_now();
  Present present();
  Present present_for(unsigned known);
  Reading& reading();

  // advance.cpp
  bool knows(double t) const;
  bool has_changed() const;
  solver::Outcome take_demand();
  solver::Outcome begin();
  solver::Outcome start_solver(bool again);
  solver::Outcome proceed(double t);
  solver::Outcome step_to(double t);
  solver::Outcome pass_event();
  solver::Outcome pass_transition();
  solver::Outcome pass_layer();
  solver::Outcome pass_contact();
  void announce_transition(const WheelFriction& before);
  void tell_pull(double t);
  void sum_up() const;
  void move_to(double t);
  solver::Outcome advance_by_stages(double t);
  void arrive(double t);
  void end_run();
  void end_as(Event event);
  void fail(const Run& before, bool changed);

  // exchange.cpp
  struct Margins {
    double friction, flat, contact;
  };
  std::array<double, WHEEL_MAX_STATES> trial() const;
  void take_at_once();
  void decide_law();
  double friction_margin() const;
  double friction_rate();
  Margins margins();
  void decide_contact(double time);
  bool starts_inside();
  double partial(unsigned unknown, unsigned known);

  // on_orbit.cpp
  struct Shape {
    double parameters[first_input] = {}, tolerance = 0;  // 0: no orbit
    bool operator==(const Shape&) const = default;
  };
  Shape shape() const;
  bool enter_orbit();
  void report_pulls_of_orbit(double t);

  Reporter reporter_;
  Demand demand_;
  Setup setup_ = {};  // of the demand, from the first state on
  Run run_;
  Owner owner_ = {setup_, run_.in_force};
  solver::Solver solver_;
  orbit::Orbit orbit_;
  Shape orbit_shape_;              // of orbit_
  bool orbit_ready_ = false;       // orbit_ is that of the present run
  double orbit_until_ = 0;         // s, own clock: how far it can be read
  const char* failure_ = nullptr;  // why the last call failed
  Reading reading_;
  enum class Fresh { nothing, state, reading } fresh_ = Fresh::nothing;  // what is known of the present instant
};

}  // namespace wheel
