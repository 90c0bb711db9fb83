// Half a swing of the free wheel is integrated, and its symmetry is tested against the right-hand side. Reduced
// form, non-spinning frame.
//
// `integrate`, once for each motion: `steady_course` tries the start for a circle or a straight line; if it is neither,
// `stepped_course` steps past T1 and T2, and `is_mirrored` tests a course that does not end. `Orbit::enter`, once for
// each run: whether the right-hand side depends on heading, roll angle and place of the start.
//
// A motion is refused where
//   a step fails, an event bends the motion, or the track is full or without memory;
//   omega_1 stays within errors between both turning points, and the wheel is not in steady motion;
//   the rates have not the symmetry of time reversed;
//   the rates depend on heading, roll angle or place.
// Both tests rest on `maps`: the rates at the image of a state are the image of its rates. An owner may add any force
// to the rates, and no list here has to name those that break the symmetry.
//
// An error, the unit of the limits below, is the change of a state that the problem's weights count as one. While a
// motion is integrated and tested for its symmetry, the weights are those of the finer tolerance with which it is
// integrated; where a run enters, they are its own.
#include "orbit.hpp"

#include <algorithm>
#include <cmath>

#include "constant.hpp"

namespace orbit {
namespace {

CONSTANT(double, finer, 0.05, "of the tolerance", "for the integrated half, whose error every half of the run repeats");
CONSTANT(double, finest, 1e-14, "1", "the tightest tolerance that rounding allows");
CONSTANT(double, loosest, 1e-8, "1", "a looser tolerance saves little in one swing, and its steps are less accurate");
CONSTANT(double, shortening, 5.0 / 6, "of the longest step", "every half of the run repeats these few steps");
CONSTANT(double, least_swing, 0.01, "errors", "a smaller swing of omega_1 may consist of the errors of a few steps");
CONSTANT(double, largest_steady, 0.003, "errors", "a wheel that swings less is in steady motion");
CONSTANT(double, largest_break, 0.1, "errors",
         "what rates that differ may add up to in the longest step: rounding alone does");
CONSTANT(double, alike, 1e-5, "1", "difference of watched functions that counts as none; rounding alone leaves 1e-14");
CONSTANT(int, samples, 8, "instants", "tests of a half; only a break that vanishes at all of them remains");
CONSTANT(double, on_the_way, 0.4, "of the half",
         "where a run is tested: not at a turning point, where a break may vanish");

// A small lean of a wheel with omega_1 = 0, in which omega_2 and omega_3 follow theta as they do along a motion.
struct Lean {
  double omega_2, omega_3;  // 1/s, their changes by that of theta
  double stiffness;         // 1/s2: omega_1_dot = -stiffness * lean
  bool indifferent;         // omega_1_dot = 0 to either side
};

Lean lean_of(const solver::Problem& problem, const double* y0) {
  CONSTANT(double, lean_tried, 1e-4, "of sin(theta)", "small against the bend of the rates, large against rounding");
  double y[states], along[states], rate[states];
  std::copy_n(y0, states, y);
  y[WHEEL_OMEGA_1] = 1;  // theta_dot = 1: these rates are derivatives by theta
  problem.derivative(problem.owner, 0, y, along);
  y[WHEEL_OMEGA_1] = 0;
  const auto tipped = [&](double by) {
    y[WHEEL_THETA] = y0[WHEEL_THETA] + by;
    y[WHEEL_OMEGA_2] = y0[WHEEL_OMEGA_2] + by * along[WHEEL_OMEGA_2];
    y[WHEEL_OMEGA_3] = y0[WHEEL_OMEGA_3] + by * along[WHEEL_OMEGA_3];
    problem.derivative(problem.owner, 0, y, rate);
    return rate[WHEEL_OMEGA_1];
  };
  const double h = lean_tried * std::sin(y0[WHEEL_THETA]), ahead = tipped(h), behind = tipped(-h);
  return {along[WHEEL_OMEGA_2], along[WHEEL_OMEGA_3], (behind - ahead) / (2 * h), ahead == 0 && behind == 0};
}

// (motion at t, its image at t_image on the run of `entry`, a map of rates) => whether the right-hand side at the image
// is the mapped one, and every watched function is the same.
template <class Map>
bool maps(const Swing& swing, const solver::Problem& problem, double t, const Entry& entry, double t_image,
          const Map& map) {
  double y[states], image[states], expected[states], rate[states], weights[states];
  swing.course().read(t, y);
  swing.read(entry, t_image, image);
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

// Whether the half from T1 to T2 represents the whole motion: as long after T2 as a state was before, the right-hand
// side is its mirror image with time reversed.
bool is_mirrored(const Swing& swing, const solver::Problem& problem) {
  const Course& course = swing.course();
  if (!(course.half_period() > 0)) return false;
  Entry from_zero;  // read without a run
  for (int i = 0; i < samples; ++i) {
    const double since = (i + 0.5) / samples * course.half_period(), t = course.T2 + since;
    const auto mirror = [&](double* rate) {  // the images of orbit.cpp, differentiated by time
      for (const int k : {WHEEL_THETA, WHEEL_OMEGA_2, WHEEL_OMEGA_3}) rate[k] = -rate[k];
      set_place(rate, -swing.half_of(from_zero, t).pose.rotation * std::conj(place_of(rate)));
    };
    if (!maps(swing, problem, course.T2 - since, from_zero, t, mirror)) return false;
  }
  return true;
}

// The circle or straight line of a start in steady motion: omega_1 = 0 except for rounding, a small lean swings instead
// of growing, and no event occurs; or it leans without consequence. Then the initial state repeats for ever.
Course steady_course(const FreeMotion& motion) {
  CONSTANT(double, least_stiffness, 1e-3, "1", "of the slowest swing's, squared: a lean that swings slower may grow");
  CONSTANT(double, piece, 0.2, "rad", "of heading in a piece of a circle");
  const solver::Problem& problem = motion.problem;
  const double* const y0 = motion.y0;
  const double omega_1 = y0[WHEEL_OMEGA_1], slowest = 1 / motion.time_scale;
  Circle circle;
  std::copy_n(y0, states, circle.y0);
  circle.y0[WHEEL_OMEGA_1] = 0;
  problem.derivative(problem.owner, 0, y0, circle.rate);
  double weights[states];
  problem.weights(problem.owner, problem.share, y0, weights);
  if (!(std::fabs(omega_1) * weights[WHEEL_OMEGA_1] < 1)) return {};
  for (int i = 0; i < problem.watched_count; ++i)
    if (problem.watched[i].value(problem.owner, problem.watched[i].event, 0, y0) < 0) return {};
  const Lean lean = lean_of(problem, y0);
  const double rate = circle.rate[WHEEL_OMEGA_1];
  const double swing = std::fabs(rate) / lean.stiffness + std::fabs(omega_1) / std::sqrt(lean.stiffness);
  const double most_weight = std::fmax(
      weights[WHEEL_THETA],
      std::fmax(std::fabs(lean.omega_2) * weights[WHEEL_OMEGA_2], std::fabs(lean.omega_3) * weights[WHEEL_OMEGA_3]));
  const bool swings = lean.stiffness > least_stiffness * slowest * slowest && swing * most_weight < largest_steady;
  if (!swings && !(omega_1 == 0 && rate == 0 && lean.indifferent)) return {};
  Course course;
  course.path = circle;
  course.T2 = std::fmin(problem.longest_step, piece / std::fabs(circle.rate[WHEEL_PSI]));
  return course;
}

// (solver) => stepped to the end of a step, past the events after which the motion goes on: their instants are the
// course's
solver::Outcome step(const FreeMotion& motion, solver::Solver& solver, Course& course) {
  for (;;) {
    const solver::Outcome outcome = solver.step();
    if (outcome != solver::Outcome::event) return outcome;
    const double t = solver.known_until();
    double y[states];
    solver.read(t, y);
    const solver::Consequence consequence = motion.on_event(motion.problem.owner, solver.event(), t, y);
    if (consequence == solver::Consequence::ends) return outcome;
    if (consequence == solver::Consequence::bends) return solver::Outcome::failed;
    course.first_time = std::fmin(course.first_time, t);
    course.first_times[solver.event()] = std::fmin(course.first_times[solver.event()], t);
    solver.resume();
  }
}

// (last step) => instant at which omega_1 falls through zero, seen from the side of `before`, on which the step begins
double turning_point(const solver::Problem& problem, double before, solver::Solver& solver) {
  const auto above = [](void*, int, double, const double* y) { return y[WHEEL_OMEGA_1]; };
  const auto below = [](void*, int, double, const double* y) { return -y[WHEEL_OMEGA_1]; };
  const solver::Watched watched = {0, before > 0 ? +above : +below, false, WHEEL_OMEGA_1};
  const double end = solver.known_until();
  long long uncounted = 0;
  const solver::Search search = {problem, solver.last_step(), watched, {}, &uncounted};
  return search.find_first_fall(search.sample(solver.step_start()), search.sample(end)).value_or(end);
}

// Steps past T1 and T2; a start with omega_1 = 0 is T1. It ends where
//   omega_1 changes its sign at T2: the motion repeats, unless omega_1 has stayed within errors since T1;
//   an event ends the motion: up to there;
//   an event bends it, a step fails, or the track is full: no course.
Course stepped_course(const FreeMotion& motion, solver::Solver& solver) {
  const solver::Problem& problem = motion.problem;
  double y[states], weights[states], largest_rate = 0, before = motion.y0[WHEEL_OMEGA_1];
  problem.weights(problem.owner, problem.share, motion.y0, weights);
  if (!solver.start(problem, solver::Method::runge_kutta, 0, motion.y0)) return {};
  Course course;
  Track& track = course.path.emplace<Track>();
  bool has_T1 = before == 0;
  for (;;) {
    const solver::Outcome outcome = step(motion, solver, course);
    if (outcome == solver::Outcome::failed || !track.add(solver.last_step())) return {};
    solver.read(solver.known_until(), y);
    const double now = y[WHEEL_OMEGA_1];
    if (now != 0 && before != 0 && std::signbit(now) != std::signbit(before)) {
      const double turning = turning_point(problem, before, solver);
      if (has_T1) {
        course.T2 = turning;
        if (largest_rate * weights[WHEEL_OMEGA_1] < least_swing) return {};
        break;
      }
      course.T1 = turning;
      has_T1 = true;
      largest_rate = 0;
    }
    if (outcome == solver::Outcome::event) {
      course.T2 = solver.known_until();
      course.ending = solver.event();
      break;
    }
    if (now != 0) before = now;
    largest_rate = std::fmax(largest_rate, std::fabs(now));
  }
  course.counters = solver.counters();
  return course;
}

// From zeros in psi, phi, X_O and Y_O. None where the motion is refused.
Swing integrate(const FreeMotion& given, solver::Solver& solver) {
  double y0[states] = {};
  for (const int i : {WHEEL_THETA, WHEEL_OMEGA_1, WHEEL_OMEGA_2, WHEEL_OMEGA_3}) y0[i] = given.y0[i];
  FreeMotion motion = given;
  motion.y0 = y0;
  motion.problem.share = std::fmax(std::fmin(finer, loosest / given.tolerance), finest / given.tolerance);
  motion.problem.longest_step *= shortening;
  Course course = steady_course(motion);
  if (!course.exists()) course = stepped_course(motion, solver);
  if (!course.exists()) return {};
  Swing swing(std::move(course));
  if (!swing.course().ending && !is_mirrored(swing, motion.problem)) return {};
  return swing;
}

}  // namespace

bool Orbit::enter(const FreeMotion& motion, solver::Solver& solver) {
  leave();
  const auto& key = motion.key;
  if (!has_integrated_ || !std::equal(key.begin(), key.end(), key_.begin())) {
    has_integrated_ = true;
    std::copy(key.begin(), key.end(), key_.begin());
    swing_ = integrate(motion, solver);
    solver.drop();
  }
  if (!course().exists()) return false;
  const Entry entry = swing_.entry_at(motion.y0, motion.most_angle);
  const double t = course().T1 + on_the_way * course().half_period();
  const auto turn = [&](double* rate) { set_place(rate, entry.start.rotation * place_of(rate)); };
  if (maps(swing_, motion.problem, t, entry, t, turn)) entry_ = entry;
  return until() >= 0;
}

}  // namespace orbit
