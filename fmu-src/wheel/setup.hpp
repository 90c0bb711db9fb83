// The demand is what the caller has set. The setup is all that follows from its parameters, and from whether the wheel
// can slide. It is computed with the initial state, never during a run. A restored run computes it anew.
#pragma once

#include <cmath>
#include <numbers>

#include "inputs.hpp"
#include "reporter.hpp"
#include "step.hpp"
#include "variables.hpp"

namespace wheel {

// Relative tolerance of the whole solution: over ten seconds of the paper's free wheel the relative error of the
// energy stays below it (docs/results/accuracy.md).
inline constexpr double default_tolerance = 1e-8, tightest_tolerance = 1e-13, loosest_tolerance = 1e-4;

// Room for a state y (wheel_equations.h), as wide as the solver's: that of a wheel that slides. A wheel that rolls has
// eight states.
using solver::max_states;
static_assert(max_states == WHEEL_SLIDING_STATES);

// Who integrates the motion.
enum class Kind : int { co_simulation, model_exchange };

// Parameters and tolerance make the setup. Inputs, their derivatives and the road may be set again later. They are in
// force from the next step on, in model exchange at once. Inputs have two writers: the caller, and `end_derivatives`.
struct Demand {
  double parameters[first_input];  // in the order of the variables; the road is the one asked for
  Polynomials inputs = {};         // from the instant at which they take effect
  double start_time = 0, stop_time = solver::never, tolerance = default_tolerance;
  Kind kind;

  // At the end of a step, at t, s, clock of the run: a derivative counts for one step, and every input stays where it
  // arrived.
  void end_derivatives(const Inputs& arrived, double t);

  // The value of a stored variable, or for k > 0 a coefficient of an input's polynomial.
  double& value(unsigned v, int k = 0) { return v < first_input ? parameters[v] : inputs[v - first_input][k]; }
  double value(unsigned v, int k = 0) const { return v < first_input ? parameters[v] : inputs[v - first_input][k]; }

  // A guided wheel in co-simulation, whose carrier turns at the rates that are inputs.
  bool is_steered() const { return parameters[variable::guided] != 0 && kind == Kind::co_simulation; }

  explicit Demand(Kind asked = Kind::co_simulation) : kind(asked) {
    for (unsigned v = 0; v < first_input; ++v) parameters[v] = row_of(v).start;
  }
};

// The state counts an angle from its start less whole turns, and a place from its start, so that a wheel that starts
// far away or after many turns loses no digits. For example, psi_start = 100 rad is counted from 100 - 32 pi. In model
// exchange the state is the whole.
struct Origin {
  double start, state;  // where the whole and the state begin
  double whole(double now) const { return start == state ? now : start + (now - state); }
};

struct Setup {
  bool model_exchange;  // another solver moves the states
  const WheelFormulation* rolling_equations;
  const WheelFormulation* sliding_equations;  // null: the wheel never slides
  WheelParameters wheel;                      // on a level road, and s = 0: the road is part of the run
  WheelContactMode first_contact;             // at the start
  bool guided;                                // the carrier keeps heading and tilt
  bool steered;                               // it also turns, at the rates that are inputs
  FrictionLaw friction_law = exact_law;
  double omega_s;  // rad/s, width of the regularized law
  SolverMethod method = automatic_method;
  bool may_unfold;  // J_x = J_y or guided, choices automatic: where nothing acts, the motion repeats (enter_orbit)
  bool keep_contact;
  double tolerance;  // relative, of the whole solution
  double initial_state[max_states];
  Origin psi, phi, X_O, Y_O;
  double tilting;                   // rad/s, initial rate of turning about e1 and e2
  double time_scale;                // s, of the wheel's motion
  double longest_step;              // s
  double length;                    // m, r_0 + r
  double weight;                    // N, or the force that the time scale stands for without a weight
  double rate_scale, moment_scale;  // rad/s, N m, of margins; powers of two, so that scaling rounds nothing
  double slip_scale;                // m/s, of the slip: error that counts as one, and of its margin
  double slow_scales[max_states];   // error of each state that counts as one while the wheel spins slowly

  // A regularized law bends within a few widths of omega_z = 0, and is steep there. Inside of that layer the solvers
  // take the law as it is. Outside, it equals the exact law to the last digit, and is replaced by it. In model exchange
  // the other solver gets the whole law.
  bool has_layer() const { return friction_law == regularized_law && !model_exchange; }
  bool is_multibody() const { return rolling_equations == &wheel_multibody; }
  bool can_slide() const { return sliding_equations != nullptr; }
};

// (parameters, tolerance, kind; whether the wheel can slide) => setup
Setup setup_of(const Demand& demand, bool can_slide);

// (motion) => y
void start_state(const WheelFormulation& formulation, const WheelParameters& wheel, const WheelMotion& motion,
                 double* y);

// The equations of the contact's mode.
inline const WheelFormulation& formulation_of(const Setup& setup, WheelContactMode contact) {
  return contact == WHEEL_SLIDES && setup.sliding_equations ? *setup.sliding_equations : *setup.rolling_equations;
}

struct Rates {
  double N, y_dot[max_states];
};
// (scene, y) => y_dot, N
inline Rates rates_of(const Setup& setup, const WheelScene& scene, const double* y) {
  Rates rates;
  rates.N = formulation_of(setup, scene.contact).derivative(&scene, y, rates.y_dot);
  return rates;
}

// (scene, y) => accelerations, reactions
inline WheelDynamics dynamics_of(const Setup& setup, const WheelScene& scene, const double* y) {
  WheelDynamics dynamics;
  formulation_of(setup, scene.contact).dynamics(&scene, y, &dynamics);
  return dynamics;
}

// (omega_z, rad/s) => scale of each state. A fast wheel hardly tilts: the range of theta falls with the square of the
// spin, and the range of the rates falls with the spin. Errors are weighed by these ranges.
void scales_at(const Setup& setup, double omega_z, double* out);

// (omega_z, rad/s) => fraction of the usual error that a step may make. Errors add up over the turns of a fast wheel,
// so the fraction is below one where the wheel turns very often within the time scale.
double share_at(const Setup& setup, double omega_z);

// Angle from lying flat, rad, below which the wheel counts as flat: at the paper's scale about 1e-8 s before theta = 0.
inline constexpr double flat_angle = 1e-7;

inline constexpr double upright = 0.5 * std::numbers::pi;  // rad
// (theta) => rad, from the side that is nearer
inline double angle_from_flat(double theta) { return upright - std::fabs(theta - upright); }

// rad: a larger angle has too few digits for a heading.
inline constexpr double largest_angle = 1e12;

// Logs one message per fault, and returns whether there is none. During a run mu_max may have been set below mu_slide.
enum class Checked { at_start, during_run };
bool check_values(const Demand& demand, bool can_slide, Checked when, const Reporter& reporter);

}  // namespace wheel
