// Half a nutation of the free wheel is integrated, and its symmetry is tested against the right-hand side. Reduced
// form, non-spinning frame; path of O in fixed axes as X_O + i Y_O.
//
// `build`, once for each motion: `is_steady` tries the start for a circle or a straight line; if it is neither,
// `follow` steps past T1 and T2, and each step goes onto the track. `unfold` then takes the half and tests it. Both
// rest on `maps`: the rates at the image of a state are the image of its rates. `begin`, once for each run: heading,
// roll angle and place of the start, and whether the right-hand side depends on them.
#include "orbit.hpp"

#include <algorithm>
#include <cmath>

#include "constant.hpp"

namespace orbit {

namespace {

CONSTANT(double, finer, 0.05, "of the tolerance", "of the integrated half, whose error is added once for every half");
CONSTANT(double, finest, 1e-14, "1", "of a tolerance: rounding allows no more");
CONSTANT(double, loosest, 1e-8, "1", "a looser one saves little in one nutation, and its steps are less accurate");
CONSTANT(double, shortening, 5.0 / 6, "of the longest step", "every turn of the run repeats these few steps");
// In units of the fraction of the tolerance.
CONSTANT(double, least_swing, 0.01, "errors", "a smaller swing of omega_1 may be the errors of a few steps");
CONSTANT(double, largest_steady, 0.003, "errors", "a wheel that swings less is in steady motion");
CONSTANT(double, largest_break, 0.1, "errors", "within the longest step, by what breaks the symmetry: rounding too");
CONSTANT(int, samples, 8, "instants", "of a half, at which its symmetry is tested");

// A small lean of a wheel with omega_1 = 0, in which omega_2 and omega_3 follow theta as they do along a motion.
struct Lean {
  double omega_2, omega_3;  // 1/s, their changes by that of theta
  double stiffness;         // 1/s2: omega_1_dot = -stiffness * lean
  bool indifferent;         // omega_1_dot = 0 to either side
};

Lean lean_of(const solver::Problem& problem, const double* y0) {
  CONSTANT(double, lean_tried, 1e-4, "of sin(theta)", "small against the bend of the rates, large against rounding");
  double y[Track::states], along[Track::states], rate[Track::states];
  std::copy_n(y0, Track::states, y);
  y[WHEEL_OMEGA_1] = 1;
  problem.derivative(problem.owner, 0, y, along);
  y[WHEEL_OMEGA_1] = 0;
  const auto tilting = [&](double by) {
    y[WHEEL_THETA] = y0[WHEEL_THETA] + by;
    y[WHEEL_OMEGA_2] = y0[WHEEL_OMEGA_2] + by * along[WHEEL_OMEGA_2];
    y[WHEEL_OMEGA_3] = y0[WHEEL_OMEGA_3] + by * along[WHEEL_OMEGA_3];
    problem.derivative(problem.owner, 0, y, rate);
    return rate[WHEEL_OMEGA_1];
  };
  const double h = lean_tried * std::sin(y0[WHEEL_THETA]), ahead = tilting(h), behind = tilting(-h);
  return {along[WHEEL_OMEGA_2], along[WHEEL_OMEGA_3], (behind - ahead) / (2 * h), ahead == 0 && behind == 0};
}

}  // namespace

// (motion at t, its image at t_image, a map of rates) => whether the right-hand side at the image is the mapped one,
// and every watched function is the same.
template <class Map>
bool Orbit::maps(const solver::Problem& problem, double t, double t_image, const Map& map) const {
  CONSTANT(double, alike, 1e-5, "1", "watched functions that differ by less are the same");
  double y[states], image[states], expected[states], rate[states], weights[states];
  read_integrated(t, y);
  read(t_image, image);
  problem.derivative(problem.owner, t, y, expected);
  map(expected);
  problem.derivative(problem.owner, t_image, image, rate);
  problem.weights(problem.owner, problem.share, y, weights);
  for (int i = 0; i < states; ++i)
    if (!(std::fabs(rate[i] - expected[i]) * problem.longest_step * weights[i] <= largest_break)) return false;
  return std::all_of(problem.watched, problem.watched + problem.watched_count, [&](const solver::Watched& watched) {
    const double a = watched.value(problem.owner, watched.event, t, y);
    const double b = watched.value(problem.owner, watched.event, t_image, image);
    return std::fabs(a - b) <= alike * (1 + std::fabs(a));
  });
}

bool Orbit::enter(const FreeMotion& motion, bool known, solver::Solver& solver) {
  if (!known || result_ == Result::refused) build(motion, solver);
  return result_ != Result::refused && begin(motion);
}

void Orbit::build(const FreeMotion& motion, solver::Solver& solver) {
  const double tolerance = motion.tolerance;
  solver::Problem problem = motion.problem;
  double from_zero[states] = {};  // psi, phi, X_O and Y_O are zero
  for (const int i : {WHEEL_THETA, WHEEL_OMEGA_1, WHEEL_OMEGA_2, WHEEL_OMEGA_3}) from_zero[i] = motion.y0[i];
  problem.share = std::fmax(std::fmin(finer, loosest / tolerance), finest / tolerance);
  problem.longest_step *= shortening;
  *this = Orbit();
  std::fill(std::begin(first_times_), std::end(first_times_), solver::never);
  if (is_steady(problem, from_zero)) return;
  result_ = follow(problem, motion.on_event, from_zero, solver);
  counters_ = solver.counters();
}

bool Orbit::begin(const FreeMotion& motion) {
  const double* y0 = motion.y0;
  latest_half_ = {};
  start_.psi_sum = y0[WHEEL_PSI];
  start_.phi_sum = y0[WHEEL_PHI];
  start_.place = place_of(y0);
  start_.rotation = std::polar(1.0, y0[WHEEL_PSI]);
  // On the way, since a straight line that starts where a watched function is the same may lead elsewhere.
  const double t = 0.6 * T2_;
  const auto turn = [&](double* rate) { set_place(rate, start_.rotation * place_of(rate)); };
  if (!maps(motion.problem, t, t, turn)) return false;
  until_ = ends() ? T2_ : motion.most_angle / (std::fmax(std::fabs(psi_growth_), std::fabs(phi_growth_)) / (T2_ - T1_));
  return true;
}

// Steps past T1 and T2; a start with omega_1 = 0 is T1. It ends where
//   omega_1 changes its sign for the second time: unfolded, if the half is mirrored;
//   the swing between both is no larger than errors: refused;
//   an event ends the motion: ended;
//   an event bends it, a step fails, or the track is full: refused.
Orbit::Result Orbit::follow(const solver::Problem& problem, FreeMotion::OnEvent on_event, const double* y0,
                            solver::Solver& solver) {
  double y[states], weights[states], swing = 0, before = y0[WHEEL_OMEGA_1];
  problem.weights(problem.owner, problem.share, y0, weights);
  bool turned = before == 0;
  if (!solver.start(problem, solver::Method::runge_kutta, 0, y0)) return Result::refused;
  for (;;) {
    const solver::Outcome outcome = step(problem, on_event, solver);
    if (outcome == solver::Outcome::failed || !track_.add(solver.last_step())) return Result::refused;
    solver.read(solver.known_until(), y);
    if (y[WHEEL_OMEGA_1] != 0 && before != 0 && std::signbit(y[WHEEL_OMEGA_1]) != std::signbit(before)) {
      T2_ = turning_point(problem, before, solver);
      if (turned && swing * weights[WHEEL_OMEGA_1] < least_swing) return Result::refused;
      if (turned) return unfold(problem, Result::unfolded) ? Result::unfolded : Result::refused;
      T1_ = T2_;
      turned = true;
      swing = 0;
    }
    if (outcome == solver::Outcome::event) {
      T2_ = solver.known_until();
      event_ = solver.event();
      return Result::ended;
    }
    if (y[WHEEL_OMEGA_1] != 0) before = y[WHEEL_OMEGA_1];
    swing = std::fmax(swing, std::fabs(y[WHEEL_OMEGA_1]));
  }
}

// (solver) => stepped to the end of a step, past the events after which the motion goes on
solver::Outcome Orbit::step(const solver::Problem& problem, FreeMotion::OnEvent on_event, solver::Solver& solver) {
  for (;;) {
    const solver::Outcome outcome = solver.step();
    if (outcome != solver::Outcome::event) return outcome;
    double y[states];
    solver.read(solver.known_until(), y);
    const solver::Consequence consequence = on_event(problem.owner, solver.event(), solver.known_until(), y);
    if (consequence == solver::Consequence::ends) return outcome;
    if (consequence == solver::Consequence::bends) return solver::Outcome::failed;
    const double t = solver.known_until();
    first_time_ = std::fmin(first_time_, t);
    first_times_[solver.event()] = std::fmin(first_times_[solver.event()], t);
    solver.resume();
  }
}

// (last step) => instant at which omega_1 falls through zero, seen from the side of `before`, on which the step begins
double Orbit::turning_point(const solver::Problem& problem, double before, solver::Solver& solver) {
  const auto value = [](void*, int side, double, const double* y) { return side * y[WHEEL_OMEGA_1]; };
  const solver::Watched watched = {before > 0 ? 1 : -1, value, false, WHEEL_OMEGA_1};
  const double end = solver.known_until();
  long long uncounted = 0;
  const solver::Search search = {problem, solver.last_step(), watched, {}, &uncounted};
  return search.find_first_fall(search.sample(solver.step_start()), search.sample(end)).value_or(end);
}

// Whether the half from T1 to T2 represents the whole motion.
bool Orbit::unfold(const solver::Problem& problem, Result kind) {
  result_ = kind;
  take_half();
  for (int i = 0; i < samples; ++i)
    if (!is_mirrored(problem, (i + 0.5) / samples * (T2_ - T1_))) return false;
  return T2_ > T1_;
}

// Whether the right-hand side, as long after T2 as the state was before, is the mirror image with time reversed.
bool Orbit::is_mirrored(const solver::Problem& problem, double since) const {
  return maps(problem, T2_ - since, T2_ + since, [&](double* rate) {
    for (const int i : {WHEEL_THETA, WHEEL_OMEGA_2, WHEEL_OMEGA_3}) rate[i] = -rate[i];
    set_place(rate, -half_of(T2_ + since).rotation * std::conj(place_of(rate)));
  });
}

// Whether the wheel is in steady motion: omega_1 = 0 except for rounding, and a small lean swings instead of growing,
// and no event occurs; or it leans without consequence. Then the initial state repeats for ever.
bool Orbit::is_steady(const solver::Problem& problem, const double* y0) {
  CONSTANT(double, least_stiffness, 1e-3, "1", "of the slowest swing's, squared: a lean that swings slower may grow");
  CONSTANT(double, piece, 0.2, "rad", "of heading in a piece of a circle");
  const double omega_1 = y0[WHEEL_OMEGA_1], slowest = 0.5 / problem.longest_step;
  double rate[states], weights[states];
  problem.derivative(problem.owner, 0, y0, rate);
  problem.weights(problem.owner, problem.share, y0, weights);
  if (!(std::fabs(omega_1) * weights[WHEEL_OMEGA_1] < 1)) return false;
  for (int i = 0; i < problem.watched_count; ++i)
    if (problem.watched[i].value(problem.owner, problem.watched[i].event, 0, y0) < 0) return false;
  const Lean lean = lean_of(problem, y0);
  if (omega_1 == 0 && rate[WHEEL_OMEGA_1] == 0 && lean.indifferent)
    return keep_steady(problem, y0, rate, problem.longest_step);
  if (!(lean.stiffness > least_stiffness * slowest * slowest)) return false;
  const double swing = std::fabs(rate[WHEEL_OMEGA_1]) / lean.stiffness + std::fabs(omega_1) / std::sqrt(lean.stiffness);
  const double most_weight = std::fmax(
      weights[WHEEL_THETA],
      std::fmax(std::fabs(lean.omega_2) * weights[WHEEL_OMEGA_2], std::fabs(lean.omega_3) * weights[WHEEL_OMEGA_3]));
  if (!(swing * most_weight < largest_steady)) return false;
  return keep_steady(problem, y0, rate, std::fmin(problem.longest_step, piece / std::fabs(rate[WHEEL_PSI])));
}

// Keeps the circle (or straight line) of a steady motion, of which any piece is a half: that of this length, s.
bool Orbit::keep_steady(const solver::Problem& problem, const double* y0, const double* rate, double length) {
  T2_ = length;
  std::copy_n(y0, states, at_T1_);
  at_T1_[WHEEL_OMEGA_1] = 0;
  std::copy_n(rate, states, steady_rate_);
  return unfold(problem, Result::steady);
}

}  // namespace orbit
