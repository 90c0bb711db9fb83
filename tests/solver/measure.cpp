// solver_measure WHAT [METHOD] [NUMBERS]: measures one thing and prints it as one line of JSON.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "measure.hpp"
#include "snapshots.hpp"
#include "table.hpp"
#include "vector.hpp"

using solver::Method;
using solver::Outcome;
using solver::Solver;

namespace {

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
  std::printf("{\"y\": \"%a %a\", \"until\": \"%a\", \"steps\": %lld, \"rhs\": %lld, \"roots\": %lld}\n", y[0], y[1],
              s.known_until(), s.counters().steps, s.counters().rhs, s.counters().roots);
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

// Sizes of the first step: of a start, and after a restart with the interval a. What is watched is far from an event.
void first_step(const Arguments& args) {
  Case c = harmonic();
  c.each_step = [](double, const double* y) { return y[0] + 2; };
  Started s(c, args.method);
  for (int i = 0; i < 5; ++i) s.step();
  double y[2];
  s.read(s.known_until(), y);
  const double free_size = s.known_until() - s.step_start();
  s.restart(c.problem(), args.method, s.known_until(), y);
  s.limit_first_step(args.a);
  const long long before = s.counters().rhs;
  s.step();
  const long long rhs = s.counters().rhs - before;
  const double limited = s.known_until() - s.step_start();
  s.step();
  std::printf("{\"free\": %.17g, \"limited\": %.17g, \"next\": %.17g, \"rhs\": %lld}\n", free_size, limited,
              s.known_until() - s.step_start(), rhs);
}

void vector(const Arguments& args) { measure_vector(static_cast<int>(args.a)); }
void snapshots(const Arguments& args) { measure_snapshots(args.method, static_cast<int>(args.a)); }
void forgeries(const Arguments& args) { measure_forgeries(args.method); }

constexpr struct {
  const char* name;
  void (*measure)(const Arguments&);
} all[] = {{"table", table},
           {"order", order},
           {"accuracy", accuracy},
           {"grid", grid},
           {"dip", dip},
           {"double_dip", double_dip},
           {"dips", dips},
           {"later_piece", later_piece},
           {"release", release},
           {"bounces", bounces},
           {"cuts", cuts},
           {"failure", failure},
           {"stiff", stiff},
           {"first_step", first_step},
           {"snapshots", snapshots},
           {"forgeries", forgeries},
           {"vector", vector},
           {"dip_beside_a_fall", dip_beside_a_fall},
           {"one_step", one_step}};

}  // namespace

int main(int count, char** arguments) {
  const auto number = [&](int i) { return i < count ? std::atof(arguments[i]) : 0; };
  const Arguments args = {static_cast<Method>(static_cast<int>(number(2))), number(3), number(4)};
  for (const auto& one : all)
    if (count > 1 && std::strcmp(one.name, arguments[1]) == 0) return one.measure(args), 0;
  return 1;
}
