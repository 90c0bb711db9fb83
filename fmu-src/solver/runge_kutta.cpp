// One step of DOP853: twelve evaluations, error estimate, step size; then the dense output.
//
// Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, second edition, sections II.4 to II.6.
#include "runge_kutta.hpp"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <utility>

#include "dormand_prince.hpp"

namespace solver {
namespace {

namespace table = dormand_prince;

// What one step may err, as a share of the tolerance of the whole solution: measured on the wheel's scenes.
constexpr double share_of_tolerance = 0.03;

constexpr int most_attempts = 40;

// By square roots, which are the same on every platform.
double eighth_root(double x) { return std::sqrt(std::sqrt(std::sqrt(x))); }

// A step is sized for an error of safety^8.
constexpr double safety = 0.9;

// A step that would end this much short of the stop, as a share of its size, ends there: it spares a step of a few
// roundings, and costs no more than 8 % of the error that a step may make.
constexpr double stretch = 1.01;

}  // namespace

template <int width>
class RungeKutta::Attempt {
 public:
  Attempt(const Problem& problem, Counters* counters, Step* step, double (*f)[max_states])
      : problem_(problem), counters_(counters), step_(*step), f_(f) {}

  void weigh() {
    std::fill_n(weights_, width, 0.0);
    problem_.weights(problem_.owner, share_of_tolerance, step_.y_start, weights_);
  }

  // f at t and y as stage i; returns the margin, NaN where the rates are not finite.
  double evaluate(int i, double t, const double* y) {
    ++counters_->rhs;
    const double margin = problem_.derivative(problem_.owner, t, y, f_[i]);
    if (margin < step_.lowest_margin) step_.lowest_margin = margin;
    return margin;
  }

  // From f and from its change over a short Euler step (II.4).
  double guess_size() {
    const double speed = norm(f_[0]), longest = problem_.longest_step;
    const double h = speed > 0 ? std::fmin(0.01 * norm(step_.y_start) / speed, 0.01 * longest) : 0;
    if (!(h > 0)) return longest;
    for (int i = 0; i < width; ++i) at_[i] = step_.y_start[i] + h * f_[0][i];
    if (std::isnan(evaluate(1, step_.start + h, at_))) return h;
    for (int i = 0; i < width; ++i) at_[i] = (f_[1][i] - f_[0][i]) / h;
    const double change = std::fmax(longest * speed, longest * longest * norm(at_));  // over the longest step
    return longest * std::fmin(1, eighth_root(0.01 / change));
  }

  // The error of the step over h in units of the weights; infinite where f is not finite.
  double try_size(double h) {
    h_ = h;
    const bool done = stage<1, table::a_1>(at_) && stage<2, table::a_2>(at_) && stage<3, table::a_3>(at_) &&
                      stage<4, table::a_4>(at_) && stage<5, table::a_5>(at_) && stage<6, table::a_6>(at_) &&
                      stage<7, table::a_7>(at_) && stage<8, table::a_8>(at_) && stage<9, table::a_9>(step_.y_inside) &&
                      stage<10, table::a_10>(at_) && stage<11, table::a_11>(at_);
    if (!done) return INFINITY;
    step_.inside_share = time_of<table::a_9>();
    end_step();
    return error();
  }

  void end_step() { advance<table::b>(step_.y_end); }

  void set_size(double h) { h_ = h; }

  bool evaluate_end(double* margin) { return !std::isnan(*margin = evaluate(12, step_.end, step_.y_end)); }

  // The three evaluations that only the dense output needs.
  bool evaluate_interior() {
    return stage<13, table::a_13>(at_) && stage<14, table::a_14>(at_) && stage<15, table::a_15>(at_);
  }

  // DOP853 gives the dense output as nested products, x = (t - start) / h:
  //   y = y_0 + x (p_0 + (1 - x) (p_1 + x (p_2 + (1 - x) (p_3 + x (p_4 + (1 - x) (p_5 + x p_6)))))).
  // Here it is sorted by the powers of s = x - 1.
  void expand() {
    const double h = h_;
    double p_3[width], p_4[width], p_5[width], p_6[width];
    combine<table::d_3>(p_3), combine<table::d_4>(p_4), combine<table::d_5>(p_5), combine<table::d_6>(p_6);
    auto& c = step_.c;
    for (int i = 0; i < width; ++i) {
      const double p_0 = step_.y_end[i] - step_.y_start[i], p_1 = h * f_[0][i] - p_0;
      const double p_2 = 2 * p_0 - h * (f_[0][i] + f_[12][i]);
      c[0][i] = step_.y_end[i];
      c[1][i] = h * f_[12][i];
      c[2][i] = (p_3[i] + p_4[i]) - (p_1 + 2 * p_2);
      c[3][i] = (2 * p_3[i] + 3 * p_4[i]) - (p_2 + p_5[i] + p_6[i]);
      c[4][i] = (p_3[i] + 3 * p_4[i]) - (3 * p_5[i] + 4 * p_6[i]);
      c[5][i] = p_4[i] - (3 * p_5[i] + 6 * p_6[i]);
      c[6][i] = -(p_5[i] + 4 * p_6[i]);
      c[7][i] = -p_6[i];
    }
    step_.degree = 7;
  }

 private:
  double norm(const double* x) const {
    double even = 0, odd = 0;
    for (int i = 0; i < width; i += 2) {
      even += (x[i] * weights_[i]) * (x[i] * weights_[i]);
      odd += (x[i + 1] * weights_[i + 1]) * (x[i + 1] * weights_[i + 1]);
    }
    return std::sqrt((even + odd) / problem_.states);
  }

  // h sum of row_j f_j.
  template <const auto& row, std::size_t... j>
  void combine(double* sum, std::index_sequence<j...>) const {
    for (int i = 0; i < width; ++i) sum[i] = h_ * ((row[j].weight * f_[row[j].stage][i]) + ...);
  }
  template <const auto& row>
  void combine(double* sum) const {
    combine<row>(sum, std::make_index_sequence<std::size(row)>());
  }
  template <const auto& row>
  void advance(double* y) const {
    double change[width];
    combine<row>(change);
    for (int i = 0; i < width; ++i) y[i] = step_.y_start[i] + change[i];
  }

  template <const auto& row>
  static constexpr double time_of() {
    double sum = 0;
    for (const table::Term& term : row) sum += term.weight;
    return sum;
  }
  template <int i, const auto& row>
  bool stage(double* y) {
    advance<row>(y);
    return !std::isnan(evaluate(i, step_.start + time_of<row>() * h_, y));
  }

  // Both estimates together, as DOP853 weighs them.
  double error() const {
    double e_3[width], e_5[width];
    combine<table::e_3>(e_3), combine<table::e_5>(e_5);
    const double high = norm(e_5), low = norm(e_3);
    return high == 0 ? 0 : high * high / std::sqrt(high * high + 0.01 * low * low);
  }

  const Problem& problem_;
  Counters* counters_;
  Step& step_;
  double (*f_)[max_states];
  double h_ = 0;
  alignas(16) double weights_[width], at_[width] = {};
};

void RungeKutta::start(double t, const double* y, int states, Step* step) {
  step->set_point(t, y, states);
  limit_ = next_limit_;
  next_limit_ = 0;
  rates_ = 0;
  last_error_ = 0;
}

// The error over h^8 changes along the motion, and is expected to change by the same factor once more (Gustafsson, ACM
// TOMS 20 (1994) 496: predictive step control). On the wheel hardly a step is rejected then.
double RungeKutta::next_size(double h, double error) {
  error = std::fmax(error, 1e-6);  // below, as after a step cut short, it says no more
  const double trend = last_error_ > 0 ? (h / size_) * eighth_root(last_error_ / error) : 1;
  last_error_ = error;
  return h * std::clamp(safety / eighth_root(error) * std::clamp(trend, 0.5, 2.0), 0.2, 10.0);
}

bool RungeKutta::advance(const Problem& problem, double stop, Counters* counters, Step* step) {
  return width_of(problem.states) == 8 ? advance_wide<8>(problem, stop, counters, step)
                                       : advance_wide<max_states>(problem, stop, counters, step);
}

template <int width>
bool RungeKutta::advance_wide(const Problem& problem, double stop, Counters* counters, Step* step) {
  step->start = step->end;
  std::copy_n(step->y_end, width, step->y_start);
  step->degree = -1;
  Attempt<width> attempt(problem, counters, step, f_);
  if (rates_ >= 13)
    std::copy_n(f_[12], width, f_[0]);
  else
    margin_ = attempt.evaluate(0, step->start, step->y_start);
  rates_ = 1;
  failure_ = std::isnan(margin_) ? "the rates of the states are not finite" : nullptr;
  if (!failure_) {
    attempt.weigh();
    if (liked_ == 0) liked_ = attempt.guess_size();
    failure_ = accept_step(attempt, problem.longest_step, stop, step);
  }
  limit_ = 0;
  if (!failure_) return true;
  rates_ = 0;
  step->end = step->start;
  std::copy_n(step->y_start, width, step->y_end);
  return false;
}

// Tries until a step is accepted, which is then done; null, or why none was.
template <int width>
const char* RungeKutta::accept_step(Attempt<width>& attempt, double longest, double stop, Step* step) {
  if (limit_ > 0) longest = std::fmin(limit_, longest);
  const double t = step->start;
  double h = std::fmin(liked_, longest);
  bool rejected = false;
  for (int attempts = 0; attempts < most_attempts; ++attempts) {
    const bool stops = t + stretch * h >= stop;
    if (stops) h = stop - t;
    if (!stops && h <= rounding_at(t)) break;
    step->end = stops ? stop : t + h;
    step->lowest_margin = margin_;
    double error = attempt.try_size(h);
    if (error <= 1 && !stops && !(attempt.evaluate_end(&margin_) && attempt.evaluate_interior())) error = INFINITY;
    if (!(error <= 1)) {
      h = liked_ = h * std::fmax(0.2, safety / eighth_root(error));
      rejected = true;
      continue;
    }
    const double next = next_size(h, error);
    // A step cut short says little: what was liked before stays. After a rejection a step does not grow.
    liked_ = rejected ? std::fmin(h, next) : h < liked_ ? std::fmax(liked_, next) : next;
    size_ = h;
    rates_ = stops ? 12 : 16;
    if (!stops) attempt.expand();
    return nullptr;
  }
  return "the step size became too small";
}

void RungeKutta::expand(const Problem& problem, Counters* counters, Step* step) {
  if (step->degree >= 0 || rates_ < 12) return;
  const auto expand_wide = [&](auto attempt) {
    attempt.set_size(size_);
    if (rates_ < 13) attempt.evaluate_end(&margin_), rates_ = 13;
    if (rates_ < 16 && attempt.evaluate_interior()) rates_ = 16;
    attempt.expand();
  };
  if (width_of(problem.states) == 8)
    expand_wide(Attempt<8>(problem, counters, step, f_));
  else
    expand_wide(Attempt<max_states>(problem, counters, step, f_));
}

bool RungeKutta::fits(const Problem& problem, Step* step) {
  if (rates_ == 0) return step->start == step->end;
  if (rates_ != 12 && rates_ != 13 && rates_ != 16) return false;
  if (!(size_ > 0) || std::fabs(step->end - step->start - size_) > rounding_at(step->end)) return false;
  Step same = *step;
  const auto repeat = [&](auto attempt) {
    attempt.set_size(size_);
    attempt.end_step();
    if (rates_ == 16) attempt.expand();
  };
  if (width_of(problem.states) == 8)
    repeat(Attempt<8>(problem, nullptr, &same, f_));
  else
    repeat(Attempt<max_states>(problem, nullptr, &same, f_));
  const bool fits = std::equal(step->y_end, step->y_end + problem.states, same.y_end);
  return *step = same, fits;
}

}  // namespace solver
