// DOP853: one step at one size, which sizes are tried, the dense output, and what is kept for the next step.
//
// Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, second edition, sections II.4 to II.6.
#include "runge_kutta.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>

#include "constant.hpp"
#include "dormand_prince.hpp"

namespace solver {
namespace {

using dormand_prince::stages;

constexpr int width = 8;  // of a problem's state

CONSTANT(double, share_of_tolerance, 0.03, "1",
         "error of a step over that of the solution, tuned on the wheel's scenes");
CONSTANT(double, share_in_bend, 0.25, "of the usual", "where a law bends: the dense output is less exact there");
CONSTANT(int, most_attempts, 40, "steps", "a step that is refused 40 times has fallen by 1e-28");
CONSTANT(double, reserve, 0.1, "of the size", "a step is shorter than fits its error, so that few are refused");
CONSTANT(double, stretch, 0.01, "of the step", "by which it grows to end at the stop: no tiny step, 8 % more error");
CONSTANT(double, widths_per_step, 1, "widths", "in a step through the bend: less than to its poles at pi / 2");
CONSTANT(double, bend, 4, "widths", "from zero to where the bend ends: 1 - tanh(4) is 7e-4");
CONSTANT(double, still, 0.2, "widths", "by which a steep state that rests moves in a step");
CONSTANT(double, far_longer, 3, "steps", "that fit into the step the motion allows, where collocation takes over");
CONSTANT(double, least_error, 1e-6, "1", "smaller errors, as after a step cut short, are mostly rounding");

// The stages that enter a row of the table.
template <const auto& matrix, int row>
constexpr auto stages_of() {
  std::array<std::size_t, stages - std::count(matrix[row], matrix[row] + stages, 0.0)> used{};
  for (std::size_t stage = 0, n = 0; stage < stages; ++stage)
    if (matrix[row][stage] != 0) used[n++] = stage;
  return used;
}

// Of stage i, from the start of the step, in its length.
template <int i>
constexpr double time_of = std::accumulate(dormand_prince::a[i], dormand_prince::a[i] + stages, 0.0);

}  // namespace

// One step of the engine.
struct RungeKutta::Work {
  RungeKutta& engine;
  const Problem& problem;
  Counters* counters;
  Step& step;
  double h = engine.size_;  // s
  alignas(16) double weights[width] = {}, at[width] = {};

  // Inlined, it would keep the loops before it from being vectorised.
  [[gnu::noinline]] double norm(const double* x) const { return weighted_norm<width>(x, weights); }

  // f at t and y as stage i; returns the least margin, NaN where the rates are not finite.
  double evaluate(int i, double t, const double* y) {
    ++counters->rhs;
    const double margin = problem.derivative(problem.owner, t, y, engine.f_[i]);
    if (margin < step.least_margin) step.least_margin = margin;
    return margin;
  }

  // (f) => h sum of row_j f_j
  template <const auto& matrix, int row>
  void combine(double* sum) const {
    constexpr auto used = stages_of<matrix, row>();
    const auto add = [&]<std::size_t... k>(std::index_sequence<k...>) {
      for (int i = 0; i < width; ++i) sum[i] = h * ((matrix[row][used[k]] * engine.f_[used[k]][i]) + ...);
    };
    add(std::make_index_sequence<used.size()>());
  }
  template <int i>
  void advance(double* y) const {
    double change[width];
    combine<dormand_prince::a, i>(change);
    for (int k = 0; k < width; ++k) y[k] = step.y_start[k] + change[k];
  }
  template <int i>
  bool stage(double* y) {
    advance<i>(y);
    return !std::isnan(evaluate(i, step.start + time_of<i> * h, y));
  }

  // The rate at the end of the step, with which the next one begins.
  bool evaluate_end() {
    engine.end_margin_ = evaluate(12, step.end, step.y_end);
    return !std::isnan(engine.end_margin_);
  }

  // (f) => error in units of the weights: both estimates together, as DOP853 weighs them
  double error() const {
    double e_3[width], e_5[width];
    combine<dormand_prince::e, 0>(e_3);
    combine<dormand_prince::e, 1>(e_5);
    const double high = norm(e_5), low = norm(e_3);
    return high == 0 ? 0 : high * high / std::sqrt(high * high + 0.01 * low * low);
  }

  // (h) => y at the end, and the error of the step in units of the weights; infinite where f is not finite.
  double try_size() {
    const bool done = stage<1>(at) && stage<2>(at) && stage<3>(at) && stage<4>(at) && stage<5>(at) && stage<6>(at) &&
                      stage<7>(at) && stage<8>(at) && stage<9>(step.y_inside) && stage<10>(at) && stage<11>(at);
    if (!done) return INFINITY;
    step.inside_at = time_of<9>;
    advance<12>(step.y_end);
    return error();
  }

  // (f) => size of the first step, from f and from its change over a short Euler step (II.4)
  double guess_size() {
    const double *f = engine.f_[0], speed = norm(f), longest = problem.longest_step;
    const double euler = speed > 0 ? std::fmin(0.01 * norm(step.y_start) / speed, 0.01 * longest) : 0;
    if (!(euler > 0)) return longest;
    for (int i = 0; i < width; ++i) at[i] = step.y_start[i] + euler * f[i];
    if (std::isnan(evaluate(1, step.start + euler, at))) return euler;
    for (int i = 0; i < width; ++i) at[i] = (engine.f_[1][i] - f[i]) / euler;
    const double change = std::fmax(longest * speed, longest * longest * norm(at));  // over the longest step
    return longest * std::fmin(1, eighth_root(0.01 / change));
  }

  // (error) => size of the next step. The error divided by h^8 changes along the motion, and is expected to change by
  // the same factor once more (Gustafsson, ACM TOMS 20 (1994) 496: predictive step control). On the wheel hardly any
  // step is then rejected.
  double next_size(double found) {
    const double error = std::fmax(found, least_error);
    const double before = engine.last_error_;
    const double trend = before > 0 ? (h / engine.size_) * eighth_root(before / error) : 1;
    engine.last_error_ = error;
    return h * std::clamp((1 - reserve) / eighth_root(error) * std::clamp(trend, 0.5, 2.0), 0.2, 10.0);
  }

  // Null, or the reason why no step is accepted.
  const char* make_step(double stop) {
    if (engine.has_end_)
      std::copy_n(engine.f_[12], width, engine.f_[0]);
    else
      engine.end_margin_ = evaluate(0, step.start, step.y_start);
    if (std::isnan(engine.end_margin_)) return "the rates of the states are not finite";
    const double share = problem.steep ? share_in_bend * problem.share : problem.share;
    problem.weights(problem.owner, share_of_tolerance * share, step.y_start, weights);
    double& liked = engine.liked_;
    if (liked == 0) liked = guess_size();
    const double in_bend = problem.steep ? longest_in_bend(*problem.steep) : INFINITY;
    const char* failure = accept_step(stop, std::fmin(in_bend, problem.longest_step), &liked);
    engine.rests_ = problem.steep && !failure && rests_after(*problem.steep, in_bend);
    return failure;
  }

  // Longest step through the bend of the steep state, s; its slope at zero is positive where the road pulls. The law
  // bends as tanh, whose poles at i pi / 2 widths end the series of the motion: the error estimate is blind to them.
  [[gnu::noinline]] double longest_in_bend(const Settling& steep) const {
    const double zero = 0;
    double slope = 0, others[max_states] = {};
    steep.slopes(problem.owner, step.start, step.y_start, {&zero, 1}, &slope, others);
    const double away = std::fmax(0, std::fabs(step.y_start[steep.state]) - bend * steep.width);
    const double speed = std::fabs(engine.f_[0][steep.state]) + std::fabs(slope) * steep.width;
    return (widths_per_step * steep.width + away) / speed;
  }

  // Whether the steep state rests after a step that `longest` limited.
  bool rests_after(const Settling& steep, double longest) const {
    const double change = std::fabs(step.y_end[steep.state] - step.y_start[steep.state]);
    const double wanted = std::fmin(engine.liked_, problem.longest_step);
    return h >= longest && change < still * steep.width && wanted > far_longer * h;
  }

  // Tries smaller and smaller steps until
  //   the error is at most one, and f is finite at the end: the step is accepted;
  //   the step is lost in the rounding of time, or most_attempts are made.
  const char* accept_step(double stop, double longest, double* liked) {
    const double limit = engine.limit_, t = step.start;
    if (limit > 0) longest = std::fmin(limit, longest);
    h = std::fmin(*liked, longest);
    bool rejected = false;
    for (int attempts = 0; attempts < most_attempts; ++attempts) {
      const bool stops = t + (1 + stretch) * h >= stop;
      if (stops) h = stop - t;
      const bool waits = stops || h == limit;  // most often the problem changes where this step ends
      if (!stops && h <= rounding_at(t)) break;
      step.end = stops ? stop : t + h;
      step.least_margin = engine.end_margin_;
      double error = try_size();
      if (error <= 1 && !waits && !evaluate_end()) error = INFINITY;
      if (!(error <= 1)) {
        h = *liked = h * std::fmax(0.2, (1 - reserve) / eighth_root(error));
        rejected = true;
        continue;
      }
      const double next = next_size(error);
      // A step that was cut short shows little, so the size wanted before it is kept. After a rejection a step does not
      // grow.
      const bool cut_short = h < std::fmin(*liked, problem.longest_step);
      *liked = rejected ? std::fmin(h, next) : cut_short ? std::fmax(*liked, next) : next;
      engine.size_ = h;
      engine.has_end_ = !waits;
      return nullptr;
    }
    return step_too_small;
  }

  // DOP853 gives the dense output as nested products, x = (t - start) / h:
  //   y = y_0 + x (p_0 + (1 - x) (p_1 + x (p_2 + (1 - x) (p_3 + x (p_4 + (1 - x) (p_5 + x p_6)))))).
  // Here it is sorted by the powers of s = x - 1.
  void expand() {
    double p_3[width], p_4[width], p_5[width], p_6[width];
    const double least_margin = step.least_margin;  // may not depend on what is read
    const bool finite = (engine.has_end_ || !std::isnan(evaluate(12, step.end, step.y_end))) && stage<13>(at) &&
                        stage<14>(at) && stage<15>(at);
    step.least_margin = least_margin;
    combine<dormand_prince::d, 0>(p_3);
    combine<dormand_prince::d, 1>(p_4);
    combine<dormand_prince::d, 2>(p_5);
    combine<dormand_prince::d, 3>(p_6);
    const auto& f = engine.f_;
    auto& c = step.c;
    step.degree = finite ? 7 : 0;
    for (int i = 0; i < width; ++i) {
      const double p_0 = step.y_end[i] - step.y_start[i], p_1 = h * f[0][i] - p_0;
      const double p_2 = 2 * p_0 - h * (f[0][i] + f[12][i]);
      c[0][i] = step.y_end[i];
      c[1][i] = h * f[12][i];
      c[2][i] = (p_3[i] + p_4[i]) - (p_1 + 2 * p_2);
      c[3][i] = (2 * p_3[i] + 3 * p_4[i]) - (p_2 + p_5[i] + p_6[i]);
      c[4][i] = (p_3[i] + 3 * p_4[i]) - (3 * p_5[i] + 4 * p_6[i]);
      c[5][i] = p_4[i] - (3 * p_5[i] + 6 * p_6[i]);
      c[6][i] = -(p_5[i] + 4 * p_6[i]);
      c[7][i] = -p_6[i];
    }
  }
};

bool RungeKutta::start(const Problem&) {
  limit_ = 0;
  rests_ = false;
  has_end_ = false;
  last_error_ = 0;
  return true;
}

bool RungeKutta::advance(const Problem& problem, double stop, Counters* counters, Step* step) {
  Work work = {*this, problem, counters, *step};
  failure_ = work.make_step(stop);
  limit_ = 0;
  return !failure_;
}

void RungeKutta::expand(const Problem& problem, Step* step) {
  Counters uncounted = {};  // else the counts would depend on the instants that are read
  Work work = {*this, problem, &uncounted, *step};
  work.expand();
}

void RungeKutta::visit(support::Archive& archive, const Problem& problem, const Step& step) {
  archive.range(limit_, 0, archive.greatest);
  archive.range(size_, 0, archive.greatest);
  archive.range(last_error_, 0, 1);
  archive.number(end_margin_);
  archive.count(rests_, 0, 1);
  archive.count(has_end_, 0, 1);
  const int known = step.end == step.start ? 0 : has_end_ ? 13 : 12;  // stages; the others follow
  for (int k = 0; k < known; ++k) archive.numbers(f_[k], problem.states);
}

}  // namespace solver
