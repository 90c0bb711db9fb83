// One step by sweeps: fixed-point iteration for all states but those that settle, Newton's method for each of these.
//
// y_j = y_start + h sum of integral_jk f_k, f_j = f(t_j, y_j), at the points t_j; in the settling state u_j f_j =
// turn_j (u_j = 1 without a speed). Hairer, Wanner, Solving Ordinary Differential Equations II, section IV.5; the dense
// output is the collocation polynomial.
#include "collocation.hpp"

#include <Eigen/LU>
#include <algorithm>

#include "constant.hpp"

namespace solver {
namespace {

using Square = Eigen::Matrix<double, radau_points, radau_points, Eigen::RowMajor>;
using Row = Eigen::Matrix<double, 1, max_states>;
using Column = Eigen::Matrix<double, radau_points, 1>;
using Rates = Eigen::Matrix<double, radau_points, max_states, Eigen::RowMajor>;

// s = (t - end) / h of the points: c - 1, c the zeros of P_6 - P_5 on (0, 1], P Legendre's polynomials.
constexpr double places[radau_points] = {-0.96019014293854872, -0.80198658212639185,  -0.56202518975261390,
                                         -0.30453572664636388, -0.098535085798826426, 0};

// Lagrange's polynomials of the points, by powers of s; their integrals from the start to each point; the last Legendre
// coefficient of the polynomial through values at the points, as weights on them.
struct Table {
  double power[radau_points][radau_points] = {}, integral[radau_points][radau_points] = {}, last[radau_points] = {};
};

constexpr double integral_of(const double (&power)[radau_points], double s) {
  double at_s = 0, at_start = 0;
  for (int m = radau_points - 1; m >= 0; --m) {
    at_s = (at_s + power[m] / (m + 1)) * s;
    at_start = -(at_start + power[m] / (m + 1));
  }
  return at_s - at_start;
}

constexpr Table make_table() {
  Table table;
  for (int k = 0; k < radau_points; ++k) {
    double (&power)[radau_points] = table.power[k];
    power[0] = 1;
    for (int j = 0, degree = 0; j < radau_points; ++j) {
      if (j == k) continue;
      for (int m = ++degree; m >= 0; --m)
        power[m] = ((m > 0 ? power[m - 1] : 0) - places[j] * (m < degree ? power[m] : 0)) / (places[k] - places[j]);
    }
    for (int j = 0; j < radau_points; ++j) table.integral[j][k] = integral_of(power, places[j]);
  }
  for (int k = 0; k < radau_points; ++k) {  // sum of (2 n + 1) w_k P_n(x_k) f_k, n = 5
    const double x = 2 * places[k] + 1, x_2 = x * x;
    table.last[k] = 11 * table.integral[radau_points - 1][k] * x * ((63 * x_2 - 70) * x_2 + 15) / 8;
  }
  return table;
}
constexpr Table radau = make_table();

CONSTANT(double, part_of_tolerance, 0.2, "1", "error of a step over that of the solution, tuned on the wheel's scenes");
CONSTANT(double, distance, 0.1, "1", "how far the sweeps may be from their limit, over the error of the step");
CONSTANT(double, error_of_last, 0.005, "1", "error of the polynomial over its last term");
CONSTANT(double, error_of_steep, 0.1, "1", "the same where a rate is steep: the terms fall less fast");
CONSTANT(int, most_sweeps, 30, "sweeps", "what is left after them is rounding");
CONSTANT(int, first_sweeps, 4, "sweeps", "before their changes fall at a rate, which is that of the size");
CONSTANT(double, slow, 0.5, "1",
         "a change over the one before: from there on a shorter step is cheaper than more sweeps");
CONSTANT(int, most_tries, 40, "steps", "a step that is refused 40 times is lost in the rounding of time");
CONSTANT(double, stretch_to_stop, 0.01, "of the step", "by which it is longer to end at the stop: no tiny step");
CONSTANT(double, leapt, 1e3, "errors", "what a step over a bend counts as: the next one is a third as long");
CONSTANT(double, most_widths, 2, "widths", "the most of a bend that six points can follow in a step");
CONSTANT(double, roundings, 2, "roundings of time", "the shortest step, in which only states that settle move");

// (rates at the points) => y at the point j of a step of this size
Row state_at(int j, const Step& step, double size, const double (&f)[radau_points][max_states]) {
  const Eigen::Map<const Rates> rates(&f[0][0]);
  return Eigen::Map<const Row>(step.y_start) + size * (Eigen::Map<const Square>(&radau.integral[0][0]).row(j) * rates);
}

// Whether the steep state passes more of its bend in the step than six points can follow: near zero most_widths,
// farther off as much more as it keeps away. The error of the polynomial does not show a bend between the points.
bool leaps(const Settling& steep, const Step& step, double size, const double (&f)[radau_points][max_states]) {
  double least = step.y_start[steep.state], largest = least;
  for (int j = 0; j < radau_points; ++j) {
    const double value = state_at(j, step, size, f)[steep.state];
    least = std::fmin(least, value);
    largest = std::fmax(largest, value);
  }
  const double away = std::fmax(0, std::fmax(least, -largest));
  return largest - least > most_widths * steep.width + away;
}

}  // namespace

// Newton's matrices for the rates at the points of the states that settle, and what follows them.
struct Collocation::Newtons {
  struct Newton {
    Eigen::PartialPivLU<Square> matrix;
    Row others = Row::Zero();
  } steep, turning;
};

// (rates at the points) => Newton's matrices
void Collocation::prepare(const Problem& problem, const Step& step, Newtons* newtons) const {
  const Eigen::Map<const Square> integral(&radau.integral[0][0]);
  const Eigen::Map<const Rates> f(&f_[0][0]);
  const auto along = [&](int i) -> Column { return (size_ * integral * f.col(i)).array() + step.y_start[i]; };
  const Row y_end = state_at(radau_points - 1, step, size_, f_);
  const auto linearize = [&](const Settling& settling, Newtons::Newton& newton) {
    Column slopes;
    const Column values = along(settling.state);
    settling.slopes(problem.owner, step.end, y_end.data(), {values.data(), radau_points}, slopes.data(),
                    newton.others.data());
    Square matrix = size_ * slopes.asDiagonal() * integral;
    matrix.diagonal() -= settling.speed == Settling::none ? Column::Ones() : along(settling.speed);
    newton.matrix.compute(matrix);
  };
  if (problem.steep) linearize(*problem.steep, newtons->steep);
  if (problem.turning) linearize(*problem.turning, newtons->turning);
}

// (rates at the points) => better rates; returns the change of the states in units of the weights, infinite where rates
// are not finite. f(y), fixed-point iteration, is corrected by Newton's method: of each state that settles, and with it
// all that follows its rate.
double Collocation::sweep(const Problem& problem, const double* weights, const Newtons& newtons, Counters* counters,
                          Step* step) {
  Eigen::Map<Rates> before(&f_[0][0]);
  Rates f = Rates::Zero();
  Column speeds;
  for (int j = 0; j < radau_points; ++j) {
    const Row y = state_at(j, *step, size_, f_);
    const double t = step->start + (1 + places[j]) * size_;
    const double margin = problem.derivative(problem.owner, t, y.data(), f.row(j).data());
    ++counters->rhs;
    if (std::isnan(margin)) return INFINITY;
    step->least_margin = j == 0 ? margin : std::fmin(step->least_margin, margin);
    if (problem.turning) speeds[j] = y[problem.turning->speed];
  }
  const auto settle = [&](const Settling& settling, const Newtons::Newton& newton) {
    const int state = settling.state;
    Column residual = f.col(state) - before.col(state);
    if (settling.speed != Settling::none) residual = speeds.cwiseProduct(residual);
    const Column settled = before.col(state) - newton.matrix.solve(residual);
    if (settling.speed == Settling::none) f += (settled - f.col(state)) * newton.others;
    f.col(state) = settled;
  };
  if (problem.steep) settle(*problem.steep, newtons.steep);
  if (problem.turning) settle(*problem.turning, newtons.turning);
  const Rates change = size_ * (f - before);
  double largest = 0;
  for (int j = 0; j < radau_points; ++j)
    if (const double norm = weighted_norm<max_states>(&change(j, 0), weights); !(norm <= largest)) largest = norm;
  before = f;
  return std::isfinite(largest) ? largest : INFINITY;
}

// (last step) => first rates: those of its polynomial, which goes on, or the rates at the start. Where a speed changes
// by its size within the step, the turning at its start is most often rounding over the speed: zero is nearer.
bool Collocation::predict(const Problem& problem, const Step& last, Counters* counters, Step* step) {
  if (last.degree != radau_points) {
    ++counters->rhs;
    if (std::isnan(problem.derivative(problem.owner, step->start, step->y_start, f_[0]))) return false;
    if (const auto& s = problem.turning)
      if (!(std::fabs(size_ * f_[0][s->speed]) < step->y_start[s->speed])) f_[0][s->state] = 0;
    for (int j = 1; j < radau_points; ++j) std::copy_n(f_[0], max_states, f_[j]);
    return true;
  }
  const double length = last.end - last.start;
  for (int j = 0; j < radau_points; ++j) {
    Row f = Row::Zero();
    for (int m = radau_points; m > 0; --m)
      f = f * ((1 + places[j]) * size_ / length) + Eigen::Map<const Row>(last.c[m]) * (m / length);
    std::copy_n(f.data(), max_states, f_[j]);
  }
  return true;
}

// (predicted rates) => rates, and the error of the step in units of the weights; infinite where the sweeps do not
// converge, or slowly. They end where
//   the change is below `distance`;
//   the changes that would follow, change^2 / (before - change), are: from the second sweep on, and where the step is
//     not predicted, from a small change on, as the first fall need not be that of the next;
//   the change is below one and does not fall, or most_sweeps are made: what is left is rounding;
//   the change is not below one and does not fall, or slowly, or is not finite: a shorter step converges faster.
double Collocation::try_size(const Problem& problem, const double* weights, bool predicted, Counters* counters,
                             Step* step) {
  Newtons newtons;
  prepare(problem, *step, &newtons);
  double change = INFINITY;
  ++counters->jacobians;
  const double largest_last = predicted ? INFINITY : 1;
  bool converged = false;
  for (int sweeps = 0; !converged; ++sweeps) {
    const double before = change;
    // A steep turning bends between two sweeps.
    if (sweeps > 0 && problem.steep) prepare(problem, *step, &newtons);
    change = sweep(problem, weights, newtons, counters, step);
    const bool falls = sweeps < most_sweeps && change < before;
    const bool is_slow = sweeps > first_sweeps && change > slow * before;
    if ((!falls || is_slow) && !(change < 1)) return INFINITY;
    converged = !falls || change < distance ||
                (sweeps > 0 && change < largest_last && change * change < distance * (before - change));
  }
  const Row last =
      (problem.steep ? error_of_steep : error_of_last) * size_ *
      (Eigen::Map<const Eigen::Matrix<double, 1, radau_points>>(radau.last) * Eigen::Map<Rates>(&f_[0][0]));
  return weighted_norm<max_states>(last.data(), weights);
}

// (wanted size, stop) => size and end of the step; whether it is `stop`, where that is near
bool Collocation::size_up(const Problem& problem, double stop, double shortest, Step* step) {
  size_ = std::fmin(std::fmax(liked_, shortest), problem.longest_step);
  const bool stops = step->start + (1 + stretch_to_stop) * size_ >= stop;
  if (stops) size_ = stop - step->start;
  step->end = stops ? stop : step->start + size_;
  return stops;
}

// (error of this step) => size of the next. Where the direction starts off its limit, errors hardly depend on the size
// of long steps; a state that settles at a speed changes as 1 / speed.
void Collocation::like(const Problem& problem, double error, int attempts, bool stops, const Step& step) {
  CONSTANT(double, spare, 0.2, "of the size", "a step is shorter than fits its error, so that few are refused");
  CONSTANT(double, rounded_error, 1e-6, "1", "smaller errors are mostly rounding");
  const double fitting = (1 - spare) / eighth_root(std::fmax(error, rounded_error));
  const double most = problem.steep && attempts > 0 ? 1 : 3;  // a step that leapt over a bend would do so again
  const double next = size_ * (known_ || attempts < 2 ? std::clamp(fitting, 0.15, most) : 0.25);
  if (!known_ || !stops || next < liked_) liked_ = next;
  if (!known_ || !problem.turning) return;
  const int speed = problem.turning->speed;
  liked_ *= std::clamp(step.y_end[speed] / step.y_start[speed], 0.4, 1.0);
}

// (its end) => the last step with its polynomial, of degree 0 where the rates are not known
Step Collocation::last_step(const Problem& problem, double end) {
  Step last = {};
  last.start = end - size_;
  last.end = end;
  if (known_) expand(problem, &last);
  return last;
}

// Tries sizes until
//   the error is at most one: the step is accepted;
//   it is not, at the shortest size, or after most_tries;
//   the rates at the start are not finite.
bool Collocation::advance(const Problem& problem, double stop, Counters* counters, Step* step) {
  double weights[max_states] = {};
  problem.weights(problem.owner, part_of_tolerance * problem.share, step->y_start, weights);
  const Step last = last_step(problem, step->start);
  const double shortest = roundings * rounding_at(step->start);
  failure_ = step_too_small;
  for (int attempts = 0; attempts < most_tries; ++attempts) {
    const bool stops = size_up(problem, stop, shortest, step);
    if (!predict(problem, last, counters, step)) {
      failure_ = "the rates of the states are not finite";
      return false;
    }
    const bool is_shortest = size_ <= shortest;
    if (is_shortest && problem.steep) weights[problem.steep->state] = 0;
    if (is_shortest && problem.turning) weights[problem.turning->state] = 0;
    double error = try_size(problem, weights, last.degree == radau_points, counters, step);
    if (error <= 1 && problem.steep && !is_shortest && leaps(*problem.steep, *step, size_, f_)) error = leapt;
    known_ = error <= 1;
    if (known_) Eigen::Map<Row>(step->y_end) = state_at(radau_points - 1, *step, size_, f_);
    like(problem, error, attempts, stops, *step);
    if (known_) failure_ = nullptr;
    if (known_ || is_shortest) return known_;
  }
  return false;
}

void Collocation::expand(const Problem&, Step* step) {
  const Eigen::Map<const Square> power(&radau.power[0][0]);
  const Eigen::Map<const Rates> f(&f_[0][0]);
  step->degree = known_ ? radau_points : 0;
  std::copy_n(step->y_end, max_states, step->c[0]);
  for (int m = 0; m < radau_points; ++m)
    Eigen::Map<Row>(step->c[m + 1]) = size_ / (m + 1) * (power.col(m).transpose() * f);
}

void Collocation::visit(support::Archive& archive, const Problem& problem, const Step&) {
  for (double* size : {&liked_, &size_}) archive.range(*size, 0, archive.greatest);
  archive.count(known_, 0, 1);
  for (int j = 0; known_ && j < radau_points; ++j) archive.numbers(f_[j], problem.states);
}

}  // namespace solver
