/* One instance of an example: stored values, states, and the step that advances them, by the Runge-Kutta method of
 * fourth order with a fixed inner step. No FMI here. */
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "model.hpp"

using Values = Eigen::Vector<double, variable_count>;

/* All values, by value reference. */
inline Values values_at(const Now& now, const States& x) {
  Values y;
  std::copy_n(now.u, first_output, y.data());
  model_outputs(now, x, y.data());
  return y;
}

struct Simulation {
  static constexpr int orders = 3;

  Now now{};
  States x = States::Zero();
  double slope[orders][input_count]{}; /* derivatives of the inputs, for one step */
  bool given[input_count]{};           /* whether the master gave the first derivative for this step */
  bool running = false;                /* parameters are fixed */

  Simulation() {
    for (int i = 0; i < first_output; ++i) now.u[i] = stored[i].start;
  }

  /* States from the parameters. */
  void start() {
    for (int i = 0; i < first_output; ++i) {
      const auto& [name, unit, _, least] = stored[i];
      if (now.u[i] >= least) continue;
      char fault[160];
      const char* relation = least > 0 ? "above" : "at least";
      std::snprintf(fault, sizeof fault, "%s = %g: it must be %s 0 %s.", name, now.u[i], relation, unit);
      throw std::invalid_argument(fault);
    }
    model_derive(now.u, now.d);
    x = model_start(now);
  }

  void go() { start(), running = true; }
  void stop() { running = false; }
  void reset() { *this = {}; }

  /* From t to t + h: the inputs follow their polynomials, which are used up. */
  void step(double t, double h) {
    now.t = now.begin = t;
    follow_rates();
    const int n = std::max(1, static_cast<int>(std::ceil(h / now.u[inner_step] - 1e-6)));
    const double e = h / n;
    Now begin = now;
    for (int i = 0; i < n; ++i) {
      const Now middle = later(h * (i + 0.5) / n), end = later(h * (i + 1) / n);
      const States k1 = model_rates(begin, x), k2 = model_rates(middle, x + e / 2 * k1);
      const States k3 = model_rates(middle, x + e / 2 * k2), k4 = model_rates(end, x + e * k3);
      x += e / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
      begin = end;
    }
    now = begin;
    now.begin = now.t;
    std::fill_n(&slope[0][0], orders * input_count, 0.0);
    std::fill_n(given, input_count, false);
  }

  /* First derivatives of the outputs along the motion, with the inputs on their slopes: (y(x + e f, u + e u', t + e) -
   * y(x - e f, ...)) / 2 e. The outputs are nearly linear along so short a line, so the error is rounding, some 1e-12
   * of y per second. */
  Values output_rates() const {
    constexpr double e = 1e-4; /* s */
    Simulation line = *this;
    line.follow_rates();
    std::fill_n(&line.slope[1][0], (orders - 1) * input_count, 0.0);
    const States f = model_rates(now, x);
    return (values_at(line.later(e), x + e * f) - values_at(line.later(-e), x - e * f)) / (2 * e);
  }

 private:
  /* The instant tau after the last communication point: the inputs on their polynomials. */
  Now later(double tau) const {
    Now then = now;
    then.t += tau;
    for (int i = 0; i < input_count; ++i)
      then.u[first_input + i] += tau * (slope[0][i] + tau / 2 * (slope[1][i] + tau / 3 * slope[2][i]));
    return then;
  }

  /* An input whose rate is an input too follows that rate where the master gives no derivative: a position that is held
   * would lag. */
  void follow_rates() {
    for (int i = 0; i < input_count; ++i)
      if (rate_of[i] >= 0 && !given[i]) slope[0][i] = now.u[first_input + rate_of[i]];
  }
};
