// One wheel in motion: parameters and inputs, the scene decided once, the solution, transitions and endings.
//
// Knows no FMI. Times are the caller's; the solver runs on its own clock, zero at the start, so that a start time of
// 1e9 s costs no digits. Messages go to the Reporter as finished sentences.
#pragma once

#include <cstddef>

#include "motion.hpp"
#include "orbit.hpp"
#include "reading.hpp"
#include "solver.hpp"
#include "variables.hpp"

namespace wheel {

// Relative tolerance of the whole solution: over ten seconds of the paper's scenes the relative error of the energy
// stays below it (docs/results/accuracy.md).
inline constexpr double default_tolerance = 1e-8, tightest_tolerance = 1e-13, loosest_tolerance = 1e-4;

enum class Topic { event, warning, error, discard };

// Where sentences go; `wanted` spares their formatting.
struct Reporter {
  void* owner;
  bool (*wanted)(void* owner, Topic topic);
  void (*tell)(void* owner, Topic topic, const char* sentence);
};

enum class Progressed { reached, ended, failed };

// Everything that decides the future of a run, except the history of its solver. Plain numbers: a run is restored by
// assignment.
struct State {
  double parameters[first_input] = {};
  double start_time = 0;
  Motion motion;
  solver::Method method = solver::Method::adams;
  Event ending = Event::none;
  bool prepared = false;         // there is a state y to read
  bool started = false;          // initialization has ended
  bool moving = false;           // the first step has been taken
  bool unfolded = false;         // the solution is read from the orbit, nothing is integrated
  bool jumped = false;           // an input or a tunable parameter changed during the run
  bool changes_pending = false;  // inputs or tunable parameters were set since the last step
  bool y_known = false;          // y is that of t; otherwise it is read from the solution when it is needed
  double t = 0;                  // s, own clock: the instant that the caller has reached
  double last_change = 0;        // s, own clock: when an input or a tunable parameter last changed
  double y[WHEEL_MAX_STATES] = {};
  long long transitions = 0;      // of the friction
  solver::Counters counted = {};  // before the solver was last started from nothing

  bool is_stepping() const { return moving && !unfolded; }
};

class Simulation {
 public:
  explicit Simulation(const Reporter& reporter) : reporter_(reporter) { reset(); }
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  // Start values again, nothing running.
  void reset();

  // tolerance <= 0: the default one.
  void set_experiment(double start_time, double tolerance);

  // Parameters and inputs: variables below stored_count. Values are checked as a whole by check_parameters.
  void store(unsigned variable, double value);
  void set_input_derivative(unsigned variable, int order, double value);

  // One sentence per fault, through the Reporter; true if there is none.
  bool check_parameters(bool report = true);

  // The initial state from the current parameters; true if it exists.
  bool prepare(bool report = true);
  // Ends the initialization; needs a successful prepare.
  void start() { state_.started = true; }
  bool started() const { return state_.started; }
  // To the caller's time t. `ended`: the wheel fell flat or lifted off at time(); `failed`: the state is that before
  // the call.
  Progressed advance(double t);

  double time() const { return state_.start_time + state_.t; }
  // Whether there is a state to read: after a successful prepare.
  bool has_state() const { return state_.prepared; }
  // What ended the run, as a sentence; null while it has not ended.
  const char* ending() const;
  // The value of a variable now; inputs just set take effect at once.
  double value(unsigned variable);
  // Its time derivative, for outputs.
  double rate(unsigned variable);
  // d output / d input at this instant; zero for what depends on inputs only through time.
  double sensitivity(unsigned output, unsigned input);

  // The complete state as portable bytes with a checksum. load_state refuses bytes that could not have been saved
  // (false) and leaves everything as it was.
  std::size_t state_size();
  void save_state(unsigned char* bytes);
  static bool is_state(const unsigned char* bytes, std::size_t size);  // whole and undamaged
  bool load_state(const unsigned char* bytes, std::size_t size);

 private:
  bool tell(Topic topic, const char* format, ...) const;
  bool check_start(bool report);

  const double* y_now();
  solver::Counters counters() const;
  Instant instant();
  Reading& reading();

  bool restore_solver(const State& next, const unsigned char* history, std::size_t size);

  // stepping.cpp
  bool has_changed() const;
  bool settle_changes();
  void announce_transition(double t, const WheelFriction& before);
  bool pass_transition();
  bool pass_contact();
  solver::Outcome pass_event();
  void report_pulls_of_orbit(double t_from, double t_to) const;
  void tell_pull(double t) const;
  bool orbit_fits() const;
  void enter_orbit();
  void build_orbit();
  bool start_solver();
  bool knows(double t) const;
  solver::Outcome run_to(double t);
  solver::Outcome extend_to(double t);
  void move_to(double t);
  Progressed end_run();
  Progressed fail(const State& before);

  Reporter reporter_;
  State state_;
  solver::Solver solver_;
  Orbit orbit_;
  bool orbit_ready_ = false;                   // orbit_ is that of the present run
  double orbit_origin_[first_input + 1] = {};  // parameters and tolerance that orbit_ was built for
  const char* failure_ = nullptr;              // why the last call failed
  Reading reading_;
  bool reading_fresh_ = false;  // reading_ holds the present instant
  mutable char ending_[160] = {};
};

}  // namespace wheel
