// The search for the first fall through zero, each on one function.
#include <cmath>
#include <cstdio>

#include "measure.hpp"

using solver::Outcome;

namespace {

// The first fall of what `c` watches, up to `end`.
void print_first_fall(const Arguments& args, Case& c, double end) {
  Started s(c, args.method);
  const bool event = run_to(s, end) == Outcome::event;
  std::printf("{\"event\": %d, \"time\": %.17g}\n", event ? s.event() : 0, s.event_time());
}

}  // namespace

// a: depth of a dip of g = 1 + sin t - a below zero at t = 3 pi / 2. Instants of the falls up to t = 20.
void dip(const Arguments& args) {
  Case c = harmonic();
  c.tolerance = 1e-6;
  c.each_step = [&](double, const double* y) { return 1 - y[1] - args.a; };
  Started s(c, args.method);
  std::printf("{\"falls\": [");
  const char* comma = "";
  while (!s.reaches(20)) {
    const Outcome outcome = run_to(s, 20);
    if (outcome != Outcome::event) break;
    const double t = s.event_time(), past = 2 * std::acos(1 - args.a) + 0.1;
    std::printf("%s%.17g", comma, t);
    comma = ", ";
    const double y[2] = {std::cos(t + past), -std::sin(t + past)};
    s.restart(c.problem(), args.method, t + past, y);
  }
  std::printf("], \"steps\": %lld, \"roots\": %lld}\n", s.counters().steps, s.counters().roots);
}

// g = (t - 0.3)^2 (t - 0.7)^2 - a with the extremes told (b = 1) or not.
void double_dip(const Arguments& args) {
  Case c = clock_only(1);
  c.by_margin = [&](double t, const double*) { return std::pow((t - 0.3) * (t - 0.7), 2) - args.a; };
  if (args.b != 0) c.extremes = {0.3, 0.5, 0.7};
  print_first_fall(args, c, 2);
}

// g = (t - c)^2 - w^2 on [0, 1] for a hundred centres c and half widths w from `a` down to 1e-7 `a`: the
// largest error of the first fall, at c - w, in units of w; infinite where a dip is missed.
void dips(const Arguments& args) {
  double worst = 0;
  long long roots = 0;
  for (int i = 0; i < 100; ++i) {
    const double centre = std::fmod(0.5 + 0.6180339887 * i, 0.8) + 0.1, width = args.a * std::pow(10, -0.07 * i);
    Case c = clock_only(1);
    c.each_step = [=](double t, const double*) { return (t - centre) * (t - centre) - width * width; };
    Started s(c, args.method);
    const Outcome outcome = run_to(s, 1);
    worst =
        std::fmax(worst, outcome == Outcome::event ? std::fabs(s.event_time() - (centre - width)) / width : INFINITY);
    roots += s.counters().roots;
  }
  std::printf("{\"worst\": %.17g, \"roots\": %lld}\n", worst, roots);
}

// g = 1 up to t = 0.5, a bend that is told, then 25 (t - 0.7)^2 - a, in a step of 1 s.
void later_piece(const Arguments& args) {
  Case c = clock_only(1);
  c.each_step = [&](double t, const double*) { return t < 0.5 ? 1 : 25 * (t - 0.7) * (t - 0.7) - args.a; };
  c.extremes = {0.5};
  print_first_fall(args, c, 1);
}

// g falls straight from 1 to 0.05 in a step of 1 s, but for a dip below zero around 0.75.
void dip_beside_a_fall(const Arguments& args) {
  Case c = clock_only(1);
  c.each_step = [](double t, const double*) { return 1 - 0.95 * t - std::fmax(0, 0.4 - 20 * (t - 0.75) * (t - 0.75)); };
  print_first_fall(args, c, 1);
}

// One step of 1 s. a = 0: g never falls, but no parabola tells. a = 1: g = (t - 1.3)^2 - 0.01 falls after it.
void one_step(const Arguments& args) {
  Case c = clock_only(1);
  c.each_step = [&](double t, const double*) {
    return args.a == 0 ? 1.001 + std::sin(777 * t) : (t - 1.3) * (t - 1.3) - 0.01;
  };
  Started s(c, args.method);
  const Outcome outcome = s.step();
  std::printf("{\"event\": %d, \"roots\": %lld, \"until\": %.17g}\n", outcome == Outcome::event, s.counters().roots,
              s.known_until());
}

// A release: g = t^2 (a - t) starts at zero with rate zero, rises, and falls at a.
void release(const Arguments& args) {
  Case c = clock_only(1);
  c.each_step = [&](double, const double* y) { return y[0] * y[0] * (args.a - y[0]); };
  print_first_fall(args, c, 10 * args.a);
}
