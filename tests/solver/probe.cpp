// One solver and its problem behind a C interface, for ctypes: problems with closed forms, no wheel, no frame. What is
// watched are functions of Python.
#include <algorithm>
#include <cmath>
#include <new>
#include <span>
#include <vector>

#include "solver.hpp"

#define PUBLIC extern "C" __attribute__((visibility("default")))

namespace {

// harmonic: y = (cos t, -sin t) from (1, 0); clock: y = t; explosive: y' = y^2; ending: y' = 1 up to t = 1, then no
// number; wave: y = sin(5 t) / 5.
// settling, falling: the speed u = t or 1 - t; the direction chi settles to sin t, u (chi - sin t)' = -4.5 (chi - sin
// t): their difference goes as u^-4.5 or u^4.5; two states as the harmonic ones, pushed by the difference. steep: chi
// settles to width sin t at a rate of up to 4.5 / width, and pushes by its difference in widths.
constexpr int states = 8;
constexpr double stiffness = 4.5, width = 1e-4;

enum Kind : int { harmonic, clock, explosive, ending, wave, settling, falling, steep };
using Watch = double (*)(double t, const double* y);

// A problem has one state or two, and others that rest at zero: a solver takes eight.
// Weights: 1 / (share tolerance (1 + |y|)), so that the norm is that of the first states alone.
struct Setting {
  Kind kind;
  solver::Method method;
  double tolerance, longest_step, y[states];
  Watch watched, later_listed, quick;  // null: nothing; quick: its value comes with the rates
  const double* extremes;
  int extreme_count;
};

struct Probe {
  Setting setting;
  solver::Solver solver;
};

const Setting& of(void* owner) { return *static_cast<Setting*>(owner); }

void rates(const Setting& s, double t, const double* y, double* d) {
  std::fill_n(d, states, 0.0);
  if (s.kind == harmonic) d[0] = y[1], d[1] = -y[0];
  if (s.kind == clock) d[0] = 1;
  if (s.kind == explosive) d[0] = y[0] * y[0];
  if (s.kind == ending) d[0] = t > 1 ? NAN : 1;
  if (s.kind == wave) d[0] = std::cos(5 * t);
  if (s.kind < settling) return;
  const double off = y[1] - std::sin(t), steep_off = std::tanh(y[1] / width) - std::tanh(std::sin(t));
  d[0] = s.kind == falling ? -1 : 1;
  d[1] = y[0] == 0 ? 0 : std::cos(t) - stiffness * off / y[0];
  if (s.kind == steep) d[1] = width * std::cos(t) - stiffness * steep_off;
  d[2] = y[3] + (s.kind == steep ? steep_off : off), d[3] = -y[2];
}

int states_of(const Setting& s) { return s.kind >= settling ? 4 : s.kind == harmonic ? 2 : 1; }

void slopes_of_turning(void*, double, const double*, std::span<const double> values, double* slopes, double*) {
  std::fill_n(slopes, values.size(), -stiffness);
}

void slopes_of_steep(void*, double, const double*, std::span<const double> values, double* slopes, double* others) {
  others[1] = 1;
  for (const double chi : values) {
    const double part = 1 / std::cosh(chi / width);
    *slopes++ = -stiffness * part * part / width;
  }
}

double derivative(void* owner, double t, const double* y, double* y_dot) {
  rates(of(owner), t, y, y_dot);
  if (!std::isfinite(y_dot[0])) return NAN;
  return of(owner).quick ? of(owner).quick(t, y) : 1;
}

void weights(void* owner, double share, const double* y, double* w) {
  const double per_state = std::sqrt(static_cast<double>(states) / states_of(of(owner)));
  for (int i = 0; i < states; ++i) w[i] = per_state / (share * of(owner).tolerance * (1 + std::fabs(y[i])));
  if (of(owner).kind == steep) w[1] /= width;
}

double watched(void* owner, int event, double t, const double* y) {
  const Setting& s = of(owner);
  return (event == 1 ? s.watched : event == 2 ? s.later_listed : s.quick)(t, y);
}

int extremes_inside(void* owner, double t_lo, double t_hi, double* instants) {
  const Setting& s = of(owner);
  const auto inside = [&](double t) { return t > t_lo && t < t_hi; };
  return static_cast<int>(std::copy_if(s.extremes, s.extremes + s.extreme_count, instants, inside) - instants);
}

solver::Problem problem_of(Probe* probe) {
  Setting& s = probe->setting;
  solver::Problem p = {};
  p.states = states, p.owner = &s, p.derivative = derivative, p.weights = weights;
  if (s.watched) p.watch({1, watched, false});
  if (s.later_listed) p.watch({2, watched, false});
  if (s.quick) p.watch({3, watched, true});
  p.near = 0.1;
  p.extremes = s.extreme_count ? extremes_inside : nullptr, p.longest_step = s.longest_step;
  if (s.kind == steep)
    p.steep = {1, solver::Settling::none, slopes_of_steep, width};
  else if (s.kind >= settling)
    p.turning = {1, 0, slopes_of_turning};
  return p;
}

}  // namespace

// At t = 0.
PUBLIC Probe* probe_new(const Setting* setting) {
  Probe* probe = new (std::nothrow) Probe{*setting, {}};
  (void)probe->solver.start(problem_of(probe), setting->method, 0, setting->y);
  return probe;
}

PUBLIC void probe_free(Probe* probe) { delete probe; }

// At most so many steps, until t is known or something else than a step happens. 0 stepped, 1 event, 2 failed.
PUBLIC int probe_run(Probe* probe, double t, long long most) {
  solver::Outcome outcome = solver::Outcome::stepped;
  while (!probe->solver.reaches(t) && outcome == solver::Outcome::stepped && most-- > 0)
    outcome = probe->solver.step(solver::never);
  return static_cast<int>(outcome);
}

PUBLIC void probe_read(const Probe* probe, double t, double* y) { probe->solver.read(t, y); }
PUBLIC const char* probe_failure(const Probe* probe) { return probe->solver.failure(); }
PUBLIC void probe_limit_first_step(Probe* probe, double dt) { probe->solver.limit_first_step(dt); }

PUBLIC void probe_resume(Probe* probe) { probe->solver.resume(); }
PUBLIC void probe_restart(Probe* probe, double t, const double* y) {
  const Setting& s = probe->setting;
  (void)probe->solver.restart(problem_of(probe), s.method, t, y);
}

// Begin of the last step, time known; steps, evaluations, roots; the function that fell last.
PUBLIC void probe_progress(const Probe* probe, double now[6]) {
  const solver::Solver& s = probe->solver;
  const solver::Counters& n = s.counters();
  const double times[] = {s.step_start(), s.known_until()};
  const long long counts[] = {n.steps, n.rhs, n.roots, s.event()};
  std::copy_n(counts, 4, std::copy_n(times, 2, now));
}

// The history of one into another, of the same setting, by way of bytes; false where it was refused.
PUBLIC int probe_copy(Probe* from, Probe* to) {
  support::Archive size = support::Archive::counting();
  from->solver.save_history(size);
  std::vector<unsigned char> bytes(size.bytes());
  support::Archive writing = support::Archive::writing(bytes.data());
  from->solver.save_history(writing);
  support::Archive reading = support::Archive::reading(bytes.data(), bytes.size());
  return to->solver.restore_history(problem_of(to), to->setting.method, reading);
}
