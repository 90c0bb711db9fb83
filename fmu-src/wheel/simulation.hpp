// One wheel behind FMI: what a caller demands, the setup that follows, the run and its solution. The functions that
// move the run are in motion.hpp and exchange.hpp; what remains here is what FMI asks for.
//
// Knows no FMI types. Times are the caller's; the run has its own clock, zero at the start, so that a start time of 1e9
// s costs no digits. Messages go to the Reporter complete.
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>

#include "exchange.hpp"
#include "reading.hpp"

namespace wheel {

// A value that counts its changes, so that what was made of it can be compared with it.
template <class Value>
class Versioned {
 public:
  explicit Versioned(const Value& value = Value()) : value_(value) {}
  const Value& operator*() const { return value_; }
  const Value* operator->() const { return &value_; }
  // To be changed; whatever was made of the value before is out of date.
  Value& change() {
    ++version_;
    return value_;
  }
  long long version() const { return version_; }

 private:
  Value value_;
  long long version_ = 0;
};

class Simulation {
 public:
  Simulation(const Reporter& reporter, Kind kind) : reporter_(reporter), demand_(Demand(kind)) {}

  // As new: start values, nothing computed.
  void reset();
  // What the caller begins: initialization, or a mode of model exchange.
  void enter(Phase phase) { run_.change().phase = phase; }
  // The end of initialization: false if there is no initial state.
  bool start();
  // The caller ends the run.
  void close();
  Phase phase() const { return run_->phase; }
  Kind kind() const { return demand_->kind; }

  // stop_time: infinite for none. tolerance <= 0: the default one.
  void set_experiment(double start_time, double stop_time, double tolerance);

  // Parameters and inputs, with their derivatives, which are checked as a whole by prepare; in a run of model exchange
  // a state too, and the law of friction is decided for it.
  void set(unsigned variable, double value, int order = 0);

  // Before the end of the initialization: the initial state from the present parameters, true if it exists. Else one
  // message per fault through the Reporter.
  bool prepare(bool report = true);
  // The same where it has not been done; the faults are reported once.
  bool is_prepared() {
    const bool done = phase() != Phase::initializing && phase() != Phase::faulty;
    return done || prepare(phase() == Phase::initializing);
  }

  // To the caller's time t. `stepped`: it was reached; `event`: the model ended at time(); `failed`: the state is that
  // before the call.
  solver::Outcome advance(double t);

  double time() const { return demand_->start_time + run_->t; }
  double stop_time() const { return demand_->stop_time; }
  bool has_ended() const { return run_->ended_by != Event::none; }
  // What ended the model, to stand behind "the wheel".
  Ending ending() const { return ending_of(setup_, run_->ended_by); }
  // The calculated variables now; inputs just set take effect at once. Valid until the next call that changes anything.
  Reading& reading() { return reading_.is_of(version()) ? reading_ : read(); }
  double value(unsigned variable) {
    return variable < stored_count ? demand_->value(variable) : row_of(variable).read(reading());
  }
  // d unknown / d known of a calculated variable: at this instant by an input, during a run in model exchange by a
  // state too, before the run by a parameter, which has none where no initial states lie near. Zero for what depends on
  // inputs only through time.
  std::optional<double> derivative(unsigned unknown, unsigned known);

  // Model exchange: see exchange.hpp.
  void set_time(double t);
  void set_states(const double* x) { std::copy_n(x, state_count, run_.change().y); }
  void states(double* x) { std::copy_n(run_->y, state_count, x); }
  void nominals(double* x) { scales_at(setup_, run_->y[setup_.formulation->spin_index], x); }
  void derivatives(double* x_dot) { wheel::derivatives(setup_, run_.change(), x_dot); }
  void indicators(double* z) { wheel::indicators(setup_, run_.change(), z); }
  bool has_event() { return wheel::has_event(setup_, run_.change()); }
  bool decide() { return wheel::decide(setup_, run_.change(), solution_, reporter_); }

  // Demand, run and the solver's history as portable bytes with a checksum. load_state returns null, or why the bytes
  // could not have been saved: everything is then as it was, unless it is the solver's history that is wrong.
  // foreign: they come from outside of this library, so the state itself is judged too.
  std::size_t state_size();
  void save_state(unsigned char* bytes);
  const char* load_state(const unsigned char* bytes, std::size_t size, bool foreign);

 private:
  void write(support::Archive& archive);
  InForce in_force_now() const;
  long long version() const { return demand_.version() + run_.version(); }
  Reading& read();
  Present present();
  Present present_for(unsigned known);
  std::optional<double> start_derivative(unsigned unknown, unsigned parameter);
  std::optional<double> partial(unsigned unknown, unsigned known);

  Reporter reporter_;
  Versioned<Demand> demand_;
  Setup setup_ = {};  // of the demand, from the first state on
  Versioned<Run> run_;
  Solution solution_;
  Reading reading_;
};

}  // namespace wheel
