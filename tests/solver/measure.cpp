// solver_measure WHAT [METHOD] [NUMBERS]: measures one thing and prints it as one line of JSON.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "problems.hpp"
#include "snapshots.hpp"
#include "table.hpp"

using solver::Method;
using solver::Outcome;
using solver::Solver;

namespace {

struct Arguments {
  Method method;
  double a, b;
};

struct Started : Solver {
  Started(Case& c, Method method) { start(c.problem(), method, 0, c.y.data()); }
};

void table(const Arguments&) { print_table(); }

// a: size of every step. Largest error of harmonic() at the ends of the steps and halfway between.
void order(const Arguments& args) {
  Case c = harmonic();
  c.tolerance = 1e20;
  c.longest_step = args.a;
  Started s(c, args.method);
  double at_ends = 0, inside = 0, y[2];
  while (s.known_until() < 4) {
    s.step();
    s.read(s.known_until(), y);
    at_ends = std::fmax(at_ends, std::fabs(y[0] - std::cos(s.known_until())));
    for (double x : {0.2, 0.5, 0.7}) {
      const double t = s.step_start() + x * (s.known_until() - s.step_start());
      s.read(t, y);
      inside = std::fmax(inside, std::fabs(y[0] - std::cos(t)));
    }
  }
  std::printf("{\"at_ends\": %.17g, \"inside\": %.17g}\n", at_ends, inside);
}

// a: tolerance, b: end. Error of harmonic() read on a grid of 1000 points.
void accuracy(const Arguments& args) {
  Case c = harmonic();
  c.tolerance = args.a;
  Started s(c, args.method);
  double error = 0;
  for (int i = 1; i <= 1000; ++i) {
    const double t = args.b * i / 1000;
    double y[2];
    run_to(s, t);
    s.read(t, y);
    error = std::fmax(error, std::hypot(y[0] - std::cos(t), y[1] + std::sin(t)));
  }
  std::printf("{\"error\": %.17g, \"steps\": %lld, \"rhs\": %lld}\n", error, s.counters().steps, s.counters().rhs);
}

// a: points of the reading grid over 20 s. What is left must not know it.
void grid(const Arguments& args) {
  Case c = harmonic();
  c.each_step = [](double, const double* y) { return y[0] + 2; };
  Started s(c, args.method);
  const int points = static_cast<int>(args.a);
  double y[2];
  for (int i = 1; i <= points; ++i) run_to(s, 20.0 * i / points), s.read(20.0 * i / points, y);
  std::printf("{\"y\": \"%a %a\", \"until\": \"%a\", \"steps\": %lld, \"rhs\": %lld}\n", y[0], y[1], s.known_until(),
              s.counters().steps, s.counters().rhs);
}

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

// g = (t - 0.3)^2 (t - 0.7)^2 - a with the extremes told (b = 1) or not: the first fall as `ended`.
void double_dip(const Arguments& args) {
  Case c = clock_only(1);
  c.by_margin = [&](double t, const double*) { return std::pow((t - 0.3) * (t - 0.7), 2) - args.a; };
  if (args.b != 0) c.extremes = {0.3, 0.5, 0.7};
  Started s(c, args.method);
  const Outcome outcome = run_to(s, 2);
  std::printf("{\"ended\": %s, \"time\": %.17g}\n", s.event() == 2 && outcome == Outcome::event ? "true" : "false",
              s.event_time());
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

// g = 1 up to t = 0.5, a bend that is told, then 25 (t - 0.7)^2 - a: the first fall in a step of 1 s.
void later_piece(const Arguments& args) {
  Case c = clock_only(1);
  c.each_step = [&](double t, const double*) { return t < 0.5 ? 1 : 25 * (t - 0.7) * (t - 0.7) - args.a; };
  c.extremes = {0.5};
  Started s(c, args.method);
  const Outcome outcome = run_to(s, 1);
  std::printf("{\"event\": %s, \"time\": %.17g}\n", outcome == Outcome::event ? "true" : "false", s.event_time());
}

// A release: g = t^2 (a - t) starts at zero with rate zero, rises, and falls at a.
void release(const Arguments& args) {
  Case c = clock_only(1);
  c.each_step = [&](double, const double* y) { return y[0] * y[0] * (args.a - y[0]); };
  Started s(c, args.method);
  const Outcome outcome = run_to(s, 10 * args.a);
  std::printf("{\"event\": %s, \"time\": %.17g}\n", outcome == Outcome::event ? "true" : "false", s.event_time());
}

// A ball dropped from 1 m keeps the share a of its speed at each of ten bounces. Instants of the bounces.
void bounces(const Arguments& args) {
  Case c = bouncing(1);
  Started s(c, args.method);
  std::printf("{\"times\": [");
  for (int i = 0; i < 10 && run_to(s, 100) == Outcome::event; ++i) {
    double y[2];
    s.read(s.event_time(), y);
    std::printf("%s%.17g", i ? ", " : "", s.event_time());
    y[0] = 0, y[1] *= -args.a;
    s.restart(c.problem(), args.method, s.event_time(), y);
  }
  std::printf("], \"restarts\": %lld}\n", s.counters().restarts);
}

// harmonic() over 20 s at tolerance 1e-8, cut every 0.1 s and again `a` s later.
void cuts(const Arguments& args) {
  Case c = harmonic();
  Started s(c, args.method);
  double error = 0, y[2];
  bool exact = true;
  for (int i = 1; i <= 400; ++i) {
    const double t = i % 2 ? 0.05 * (i + 1) : 0.05 * i + args.a;
    while (!s.reaches(t)) {
      s.stop_before(t);
      if (s.step() != Outcome::stepped) return void(std::printf("{\"failed\": \"%s\"}\n", s.failure()));
    }
    exact = exact && std::fabs(s.known_until() - t) <= solver::rounding_at(t);
    s.read(t, y);
    error = std::fmax(error, std::hypot(y[0] - std::cos(t), y[1] + std::sin(t)));
  }
  std::printf("{\"error\": %.17g, \"exact\": %s, \"steps\": %lld, \"restarts\": %lld}\n", error,
              exact ? "true" : "false", s.counters().steps, s.counters().restarts);
}

// y' = y^2 from 1 ends at t = 1; rates that are no numbers beyond t = 1 end there too (a = 1).
void failure(const Arguments& args) {
  Case c = growth(1);
  if (args.a != 0)
    c.rates = [](double t, const double*, double* d) { d[0] = t > 1 ? NAN : 1; };
  else
    c.rates = [](double, const double* y, double* d) { d[0] = y[0] * y[0]; };
  Started s(c, args.method);
  const Outcome outcome = run_to(s, 2, 100000);
  double y[1];
  s.read(s.known_until(), y);
  std::printf("{\"failed\": %s, \"until\": %.17g, \"y\": %.17g, \"why\": \"%s\"}\n",
              outcome == Outcome::failed ? "true" : "false", s.known_until(), y[0], s.failure());
}

// van_der_pol(a) at t = b, tolerance 1e-7.
void stiff(const Arguments& args) {
  Case c = van_der_pol(args.a);
  c.tolerance = 1e-7;
  c.longest_step = 1000;
  Started s(c, args.method);
  run_to(s, args.b, 200000);
  double y[2];
  s.read(args.b, y);
  std::printf("{\"y\": %.17g, \"steps\": %lld, \"rhs\": %lld, \"jacobians\": %lld}\n", y[0], s.counters().steps,
              s.counters().rhs, s.counters().jacobians);
}

// Sizes of the first step: of a start, and after a restart with the interval a.
void first_step(const Arguments& args) {
  Case c = harmonic();
  Started s(c, args.method);
  for (int i = 0; i < 5; ++i) s.step();
  double y[2];
  s.read(s.known_until(), y);
  const double free_size = s.known_until() - s.step_start();
  s.restart(c.problem(), args.method, s.known_until(), y);
  s.limit_first_step(args.a);
  s.step();
  const double limited = s.known_until() - s.step_start();
  s.step();
  std::printf("{\"free\": %.17g, \"limited\": %.17g, \"next\": %.17g}\n", free_size, limited,
              s.known_until() - s.step_start());
}

void snapshots(const Arguments& args) { measure_snapshots(args.method, static_cast<int>(args.a)); }
void forgeries(const Arguments& args) { measure_forgeries(args.method); }

constexpr struct {
  const char* name;
  void (*measure)(const Arguments&);
} all[] = {{"table", table},     {"order", order},           {"accuracy", accuracy},   {"grid", grid},
           {"dip", dip},         {"double_dip", double_dip}, {"dips", dips},           {"later_piece", later_piece},
           {"release", release}, {"bounces", bounces},       {"cuts", cuts},           {"failure", failure},
           {"stiff", stiff},     {"first_step", first_step}, {"snapshots", snapshots}, {"forgeries", forgeries}};

}  // namespace

int main(int count, char** arguments) {
  const auto number = [&](int i) { return i < count ? std::atof(arguments[i]) : 0; };
  const Arguments args = {static_cast<Method>(static_cast<int>(number(2))), number(3), number(4)};
  for (const auto& one : all)
    if (count > 1 && std::strcmp(one.name, arguments[1]) == 0) return one.measure(args), 0;
  return 1;
}
