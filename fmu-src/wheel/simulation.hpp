// One wheel behind FMI: what FMI asks for, passed on to the functions over a wheel, and the present reading.
//
// Knows no FMI types. Times are the caller's; the run has its own clock, zero at the start, so that a start time of 1e9
// s costs no digits. Messages go to the Reporter complete.
#pragma once

#include <algorithm>
#include <cstddef>

#include "exchange.hpp"
#include "logbook.hpp"
#include "slopes.hpp"
#include "snapshot.hpp"

namespace wheel {

class Simulation {
 public:
  Simulation(const Reporter& reporter, Kind kind) : wheel_(reporter, kind) {}

  // As new: start values, nothing computed.
  void reset();
  // What the caller begins: initialization, or a mode of model exchange.
  void enter(Phase phase) { change().run.phase = phase; }
  // The end of initialization: false if there is no initial state.
  bool start();
  // The caller ends the run.
  void close();
  Phase phase() const { return wheel_.run.phase; }
  Kind kind() const { return wheel_.demand.kind; }

  // stop_time: infinite for none. tolerance <= 0: the default one.
  void set_experiment(double start_time, double stop_time, double tolerance);

  // Parameters and inputs, with their derivatives, which are checked as a whole by prepare; in a run of model exchange
  // a state too, and the law of friction is decided for it.
  void set(unsigned variable, double value, int order = 0);

  // Before the end of the initialization: the initial state from the present parameters, where it has not been
  // computed, true if it exists. Else one message per fault, once.
  bool is_prepared() {
    const bool done = phase() != Phase::initializing && phase() != Phase::faulty;
    return done || prepare(change(), phase() == Phase::initializing ? wheel_.reporter : Reporter());
  }

  // To the caller's time t. `stepped`: it was reached; `event`: the model ended at time(); `failed`: the state is that
  // before the call.
  [[nodiscard]] solver::Outcome advance(double t);

  double time() const { return wheel_.demand.start_time + wheel_.run.t; }
  double stop_time() const { return wheel_.demand.stop_time; }
  bool can_slide() const { return wheel_.setup.sliding; }
  bool has_ended() const { return wheel_.run.ended_by != Event::none; }
  // What ended the model, to stand behind "the wheel".
  Ending ending() const { return ending_of(wheel_.run.in_force, wheel_.run.ended_by); }
  // The calculated variables now; inputs just set take effect at once. Valid until the next call that changes anything.
  Reading& reading() {
    if (!reading_.is_set()) reading_.set(present(wheel_));
    return reading_;
  }
  double value(unsigned variable) {
    return variable < stored_count ? wheel_.demand.value(variable) : row_of(variable).read(reading());
  }
  // See slopes.hpp.
  bool add_slopes(unsigned known, double seed, const unsigned* unknowns, std::size_t count, double* sums) {
    return wheel::add_slopes(change(), known, seed, unknowns, count, sums);
  }
  void read_rates(const unsigned* outputs, std::size_t count, double* out) {
    wheel::read_rates(wheel_, outputs, count, out);
  }

  // Model exchange: see exchange.hpp.
  void set_time(double t);
  void set_states(const double* x) { std::copy_n(x, state_count, change().run.y); }
  void states(double* x) { std::copy_n(wheel_.run.y, state_count, x); }
  void nominals(double* x) { scales_at(wheel_.setup, wheel_.run.y[wheel_.setup.formulation->spin_index], x); }
  void derivatives(double* x_dot) { wheel::derivatives(wheel_, x_dot); }
  void indicators(double* z) { wheel::indicators(wheel_, z); }
  bool has_event() { return wheel::has_event(wheel_); }
  bool decide() { return wheel::decide(change()); }

  // See snapshot.hpp.
  std::size_t state_size() { return wheel::state_size(wheel_); }
  void save_state(unsigned char* bytes) { wheel::save_state(wheel_, bytes); }
  const char* load_state(const unsigned char* bytes, std::size_t size) {
    return wheel::load_state(change(), bytes, size);
  }

 private:
  // The wheel to be changed: what was read of it is out of date. Counts and run.y are not read from the reading.
  Wheel& change() {
    reading_.forget();
    return wheel_;
  }

  Wheel wheel_;
  Reading reading_;
};

}  // namespace wheel
