// One free wheel and its orbit behind a C interface, for ctypes. State and units as in wheel_equations.h.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <new>

#include "orbit.hpp"
#include "wheel_equations.h"

#ifdef _WIN32
#define PUBLIC extern "C" __declspec(dllexport)
#else
#define PUBLIC extern "C" __attribute__((visibility("default")))
#endif

namespace {

struct Probe {
  WheelScene scene = {};
  double tolerance = 0, scales[8] = {}, weight = 0, start[8] = {};
  bool keep_contact = false;
  solver::Problem problem = {};
  solver::Solver solver;
  wheel::Orbit orbit;
};

double margin(const Probe& probe, const double* y, double N) {
  const double height = std::sin(y[0]) - 1e-7;
  return probe.keep_contact ? height : std::fmin(height, N / probe.weight + 1e-9);
}

double derivative(void* owner, double, const double* y, double* y_dot) {
  const Probe& probe = *static_cast<Probe*>(owner);
  const double N = wheel_reduced.derivative(&probe.scene, y, y_dot);
  double sum = 0;
  for (int i = 0; i < 8; ++i) sum += y_dot[i];
  return std::isfinite(sum) ? margin(probe, y, N) : std::numeric_limits<double>::quiet_NaN();
}

double force(void* owner, double, const double* y) {
  double y_dot[8];
  return wheel_reduced.derivative(&static_cast<Probe*>(owner)->scene, y, y_dot);
}

double boundary(void* owner, double t, const double* y) {
  return margin(*static_cast<Probe*>(owner), y, force(owner, t, y));
}

void weights(void* owner, double share, const double* y, double* weights) {
  const Probe& probe = *static_cast<Probe*>(owner);
  constexpr double rounding = 32 * std::numeric_limits<double>::epsilon();
  for (int i = 0; i < 8; ++i) weights[i] = 1 / (share * probe.tolerance * probe.scales[i] + rounding * std::fabs(y[i]));
}

// The scales of the product: angles 1 rad (psi and phi 3), rates those of the wheel or of its start, lengths r_0 + r.
void scale(Probe& probe) {
  const WheelParameters& wheel = probe.scene.wheel;
  const double* y = probe.start;
  const double length = wheel.r_0 + wheel.r, tilting = std::hypot(y[1], y[2]), spinning = std::hypot(tilting, y[3]);
  const double slowest = wheel.g > 0 ? std::sqrt(wheel.g / length) : spinning > 0 ? spinning : 1;
  const double turn = std::fmax(slowest, tilting), rate = std::fmax(slowest, spinning);
  const double scales[] = {1, turn, turn, rate, 3, 3, 3 * length, 3 * length};
  std::copy_n(scales, 8, probe.scales);
  probe.weight = wheel.m * length * slowest * slowest;
  probe.problem.longest_step = 0.5 / slowest;
}

}  // namespace

PUBLIC Probe* probe_make(const WheelParameters* wheel, const WheelMotion* motion, double tolerance, int keep_contact) {
  Probe* probe = new (std::nothrow) Probe;
  if (!probe) return nullptr;
  probe->scene.wheel = *wheel;
  probe->scene.friction.kind = WHEEL_FRICTIONLESS;
  probe->tolerance = tolerance;
  probe->keep_contact = keep_contact != 0;
  wheel_reduced.start(wheel, motion, probe->start);
  probe->problem.states = 8;
  probe->problem.owner = probe;
  probe->problem.derivative = derivative;
  probe->problem.weights = weights;
  probe->problem.boundary = boundary;
  probe->problem.near = 0.1;
  scale(*probe);
  return probe;
}

PUBLIC void probe_free(Probe* probe) { delete probe; }

// 0 refused, 1 folded, 2 ended.
PUBLIC int probe_build(Probe* probe) {
  return static_cast<int>(probe->orbit.build(probe->problem, probe->tolerance, probe->keep_contact ? force : nullptr,
                                             probe->start, probe->solver));
}

// States at `count` instants, 8 numbers each, and N.
PUBLIC void probe_read(Probe* probe, const double* t, int count, double* y, double* N) {
  for (int i = 0; i < count; ++i) {
    probe->orbit.read(t[i], y + 8 * i);
    N[i] = force(probe, t[i], y + 8 * i);
  }
}

PUBLIC double probe_end_time(Probe* probe) { return probe->orbit.end_time(); }
PUBLIC double probe_half_period(Probe* probe) { return probe->orbit.half_period(); }
PUBLIC long long probe_falls_until(Probe* probe, double t) { return probe->orbit.falls_until(t); }
PUBLIC double probe_fall(Probe* probe, long long n) { return probe->orbit.fall(n); }
PUBLIC long long probe_steps(Probe* probe) { return probe->solver.counters().steps; }

// Seconds for one build, and for one of `count` readings at steps of dt: the best of some rounds.
PUBLIC void probe_time(Probe* probe, double dt, int count, double seconds[2]) {
  using Clock = std::chrono::steady_clock;
  seconds[0] = seconds[1] = std::numeric_limits<double>::infinity();
  for (int round = 0; round < 20; ++round) {
    double y[8];
    const Clock::time_point start = Clock::now();
    probe_build(probe);
    const Clock::time_point built = Clock::now();
    for (int i = 0; i < count; ++i) probe->orbit.read(i * dt, y);
    const Clock::time_point read = Clock::now();
    seconds[0] = std::fmin(seconds[0], std::chrono::duration<double>(built - start).count());
    seconds[1] = std::fmin(seconds[1], std::chrono::duration<double>(read - built).count() / count);
  }
}
