// One wheel in motion: parameters and inputs, the scene decided once, the solution, events and endings.
//
// Knows no FMI. Times are the caller's; the solver runs on its own clock, zero at the start, so that a start time of
// 1e9 s costs no digit. Messages go to the Reporter as finished sentences.
#pragma once

#include <cstddef>

#include "inputs.hpp"
#include "integrator.hpp"
#include "reading.hpp"
#include "variables.hpp"

namespace wheel {

// Relative tolerance of the whole solution: over ten seconds of the paper's scenes the relative error of the energy
// stays below it (measured: docs/results/accuracy.md). The local tolerance of a step is this fraction of it.
inline constexpr double default_tolerance = 1e-8, tightest_tolerance = 1e-13, loosest_tolerance = 1e-2;
inline constexpr double local_fraction = 0.003;

enum class Topic { event, warning, error, discard };

// Where sentences go; `wanted` spares their formatting.
struct Reporter {
  void* owner;
  bool (*wanted)(void* owner, Topic topic);
  void (*tell)(void* owner, Topic topic, const char* sentence);
};

enum class Progressed { reached, ended, failed };

class Simulation {
 public:
  explicit Simulation(const Reporter& reporter);
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  // Start values again, nothing running.
  void reset();

  // tolerance <= 0: the default one.
  void set_experiment(double start_time, double tolerance);

  // Stored variables (parameters and inputs). Values are checked as a whole by check_parameters.
  double stored(unsigned variable) const { return stored_[variable]; }
  void store(unsigned variable, double value);
  void set_input_derivative(unsigned variable, int order, double value);

  // One sentence per fault, through the Reporter; true if there is none.
  bool check_parameters(bool report = true) const;

  // The initial state from the current parameters; true if it exists.
  bool prepare(bool report = true);
  // Starts the solver. False if SUNDIALS refuses it.
  bool start();
  // To the caller's time t. `ended`: the wheel fell flat or lifted off at time(); `failed`: time() is that of the
  // start.
  Progressed advance(double t);

  double time() const;
  // Whether there is a state to read: after a successful prepare.
  bool exists() const { return formulation_ != nullptr; }
  // The value of a variable now; inputs just set take effect at once.
  double value(unsigned variable);
  double rate(unsigned variable);
  // d output / d input at this instant; zero for what depends on inputs only through time.
  double sensitivity(unsigned output, unsigned input);

  // What a Reading asks for.
  const integrator::Integrator* solution() const { return solver_; }
  const WheelParameters& wheel() const { return scene_.wheel; }
  WheelScene scene_at(double t, const double* y) const;
  WheelLoad load_rate_at(double t) const;

  // Complete state as portable bytes with a checksum. is_state: whether bytes are such a state, undamaged. load_state
  // needs that; it returns false only where start() does.
  std::size_t state_size();
  void save_state(unsigned char* bytes);
  static bool is_state(const unsigned char* bytes, std::size_t size);
  bool load_state(const unsigned char* bytes);

 private:
  friend struct Callbacks;
  struct Moment {
    bool prepared, started;
    double t;
    long long events;
    double y[WHEEL_MAX_STATES];
  };
  Moment moment_now();
  template <class Archive>
  void visit(Archive& archive, Moment& moment);

  bool tell(Topic topic, const char* format, ...) const;
  bool check_start(bool report);
  bool restart_from(double t, const double* y);
  bool joins(double t, const double* y, const WheelScene& next) const;
  bool settle_changes();
  void announce_transition(double t, const WheelFriction& before);
  bool pass_event();
  integrator::Outcome run_to(double t);
  Progressed end_run();

  Reporter reporter_;
  double stored_[stored_count];
  Inputs inputs_;
  double start_time_ = 0, tolerance_ = default_tolerance;

  WheelScene scene_ = {};  // its load follows the solver's right-hand side
  const WheelFormulation* formulation_ = nullptr;
  integrator::Method method_ = integrator::Method::adams;
  double scales_[WHEEL_MAX_STATES] = {};  // error of each state that weighs like a tolerance of one
  integrator::Integrator* solver_ = nullptr;
  Reading now_;
  double weight_ = 0;        // N, the scale of the normal force
  double lowest_force_ = 0;  // N, smallest normal force the right-hand side has seen since the last step
  bool lifted_ = false;      // the ground is pulling, and that has been said
  bool touched_ = false;     // inputs or tunable parameters were set since the last step
  integrator::Room room_;    // the solver's
};

}  // namespace wheel
