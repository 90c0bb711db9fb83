// The problems, and how functions become callbacks.
#include "problems.hpp"

#include <cmath>

namespace {

Case& of(void* owner) { return *static_cast<Case*>(owner); }

double margin(void* owner, int, double t, const double* y) {
  const Case& c = of(owner);
  return c.by_margin ? c.by_margin(t, y) : 1;
}

double derivative(void* owner, double t, const double* y, double* y_dot) {
  const Case& c = of(owner);
  c.rates(t, y, y_dot);
  for (int i = 0; i < c.states; ++i)
    if (!std::isfinite(y_dot[i])) return NAN;
  return margin(owner, 0, t, y);
}

void weights(void* owner, double share, const double* y, double* w) {
  const Case& c = of(owner);
  for (int i = 0; i < c.states; ++i) w[i] = 1 / (share * c.tolerance * (1 + std::fabs(y[i])));
}

double watched(void* owner, int, double t, const double* y) { return of(owner).each_step(t, y); }

int extremes_inside(void* owner, double t_lo, double t_hi, double* instants) {
  int count = 0;
  for (double t : of(owner).extremes)
    if (t > t_lo && t < t_hi) instants[count++] = t;
  return count;
}

}  // namespace

solver::Problem Case::problem() {
  states = static_cast<int>(y.size());
  solver::Problem p = {};
  p.states = states, p.owner = this, p.derivative = derivative, p.weights = weights;
  if (each_step) p.watch({1, watched, false});
  if (by_margin) p.watch({2, margin, true});
  p.extremes = extremes.empty() ? nullptr : extremes_inside, p.near = near, p.longest_step = longest_step;
  return p;
}

Case harmonic() {
  Case c;
  c.y = {1, 0};
  c.rates = [](double, const double* y, double* d) { d[0] = y[1], d[1] = -y[0]; };
  return c;
}

Case growth(double rate) {
  Case c;
  c.y = {1};
  c.rates = [rate](double, const double* y, double* d) { d[0] = rate * y[0]; };
  return c;
}

Case van_der_pol(double mu) {
  Case c;
  c.y = {2, 0};
  c.rates = [mu](double, const double* y, double* d) { d[0] = y[1], d[1] = mu * (1 - y[0] * y[0]) * y[1] - y[0]; };
  return c;
}

Case bouncing(double height) {
  Case c;
  c.y = {height, 0};
  c.rates = [](double, const double* y, double* d) { d[0] = y[1], d[1] = -9.81; };
  c.each_step = [](double, const double* y) { return y[0]; };
  return c;
}

Case clock_only(double longest_step) {
  Case c;
  c.y = {0};
  c.longest_step = longest_step;
  c.rates = [](double, const double*, double* d) { d[0] = 1; };
  return c;
}

solver::Outcome run_to(solver::Solver& solver, double t, long long most_steps) {
  solver::Outcome outcome = solver::Outcome::stepped;
  while (!solver.reaches(t) && outcome == solver::Outcome::stepped && most_steps-- > 0) outcome = solver.step();
  return outcome;
}
