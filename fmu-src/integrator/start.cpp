// The start of high order, after every jump of the right-hand side: one Runge-Kutta step of Dormand and Prince (order
// 8, dense output of order 7) from the jump on, and its polynomial as the history CVODE goes on from.
//
// CVODE itself starts at order one with a tiny step and needs some thirty steps to come back to order 7 or 8. Measured
// in docs/results/work_precision.md.
#include "start.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>
#include <utility>

#include "cvode_impl.h"
#include "dormand_prince.hpp"
#include "state_vector.hpp"

namespace integrator {
namespace {

namespace table = dormand_prince;

constexpr int start_order = 7;

// CVODE's first step as a share of the start: what a step of Adams at this order is to one of Runge and Kutta.
constexpr double adams_share = 0.2;

// As often as CVODE tries a step of its own (integrator.cpp).
constexpr int most_attempts = 30;

// The step from (t, y) over h, for `pairs` pairs of states.
template <int pairs>
class StartStep {
 public:
  explicit StartStep(Integrator::Implementation& self)
      : self_(self), t_(self.progress.known_until), y_(state_pairs(self.y)), weights_(state_pairs(self.scratch)) {
    self.system.weights(self.system.owner, data(self.y), data(self.scratch));
  }

  bool evaluate_start() { return evaluate(0, y_, f_[0]); }

  // A first guess of h, from f and from its change over a short Euler step (Hairer, Norsett, Wanner I, II.4).
  double guess_size() {
    const double speed = norm(f_[0]), scale = self_.system.longest_step;
    const double h = speed > 0 ? std::fmin(0.01 * norm(y_) / speed, 0.01 * scale) : 0;
    if (!(h > 0)) return scale;
    for (int i = 0; i < pairs; ++i) y_end_[i] = y_[i] + h * f_[0][i];
    if (!evaluate(h, y_end_, f_[1])) return h;
    StatePair bend[pairs];
    for (int i = 0; i < pairs; ++i) bend[i] = (f_[1][i] - f_[0][i]) / h;
    const double change = std::fmax(scale * speed, scale * scale * norm(bend));  // over the longest step
    return scale * std::fmin(1, std::pow(0.01 / change, 1.0 / 8));
  }

  // The error of the step over h in units of the weights; infinite where the right-hand side fails.
  double attempt(double h) {
    h_ = h;
    const bool done = stage<1, table::a_1>(at_) && stage<2, table::a_2>(at_) && stage<3, table::a_3>(at_) &&
                      stage<4, table::a_4>(at_) && stage<5, table::a_5>(at_) && stage<6, table::a_6>(at_) &&
                      stage<7, table::a_7>(at_) && stage<8, table::a_8>(at_) && stage<9, table::a_9>(at_) &&
                      stage<10, table::a_10>(at_) && stage<11, table::a_11>(at_) && stage<12, table::b>(y_end_);
    return done ? error() : INFINITY;
  }

  // The three stages that only the dense output needs.
  bool evaluate_interior() {
    return stage<13, table::a_13>(at_) && stage<14, table::a_14>(at_) && stage<15, table::a_15>(at_);
  }

  // Coefficients p_j of (t / h - 1)^j, j = 0 ... 7, of the dense output, t counted from the start of the step. DOP853
  // gives it as nested products: y = y_0 + x (c_0 + (1 - x) (c_1 + x (c_2 + ... + x c_6))), x = t / h.
  void expand_at_end(StatePair (*p)[pairs]) const {
    StatePair c[7][pairs];
    combine<table::b>(c[0]);  // y_1 - y_0, without the rounding of y
    for (int i = 0; i < pairs; ++i) {
      c[1][i] = h_ * f_[0][i] - c[0][i];
      c[2][i] = 2 * c[0][i] - h_ * (f_[0][i] + f_[12][i]);
    }
    combine<table::d_3>(c[3]), combine<table::d_4>(c[4]), combine<table::d_5>(c[5]), combine<table::d_6>(c[6]);
    std::memset(p, 0, sizeof *p * (start_order + 1));
    for (int i = 0; i < pairs; ++i)
      for (int k = 6; k >= 0; --k) {
        p[0][i] += c[k][i];
        for (int j = 7 - k; j > 0; --j) p[j][i] = k % 2 == 0 ? p[j][i] + p[j - 1][i] : -p[j - 1][i];  // by x or 1 - x
        if (k % 2 == 1) p[0][i] = StatePair{0, 0};
      }
    std::memcpy(p[0], y_end_, sizeof *p);
  }

 private:
  bool evaluate(double after, const StatePair* y, StatePair* y_dot) {
    ++self_.progress.counters.rhs;
    return self_.system.derivative(self_.system.owner, t_ + after, reinterpret_cast<const double*>(y),
                                   reinterpret_cast<double*>(y_dot), 2 * pairs);
  }

  double norm(const StatePair* x) const {
    StatePair sum = {0, 0};
    for (int i = 0; i < pairs; ++i) sum += (x[i] * weights_[i]) * (x[i] * weights_[i]);
    return std::sqrt((sum[0] + sum[1]) / (2 * pairs));
  }

  // h sum of row_j f_j.
  template <const auto& row, std::size_t... k>
  void combine(StatePair* sum, std::index_sequence<k...>) const {
    for (int i = 0; i < pairs; ++i) sum[i] = h_ * ((row[k].weight * f_[row[k].stage][i]) + ...);
  }
  template <const auto& row>
  void combine(StatePair* sum) const {
    combine<row>(sum, std::make_index_sequence<std::size(row)>());
  }

  template <int i, const auto& row>
  bool stage(StatePair* y) {
    double time = 0;
    for (const table::Term& term : row) time += term.weight;
    combine<row>(y);
    for (int k = 0; k < pairs; ++k) y[k] += y_[k];
    return evaluate(time * h_, y, f_[i]);
  }

  // Both estimates together, as DOP853 weighs them.
  double error() const {
    StatePair e_3[pairs], e_5[pairs];
    combine<table::e_3>(e_3), combine<table::e_5>(e_5);
    const double high = norm(e_5), low = norm(e_3);
    return high == 0 ? 0 : high * high / std::sqrt(high * high + 0.01 * low * low);
  }

  Integrator::Implementation& self_;
  double t_, h_ = 0;
  const StatePair *y_, *weights_;
  StatePair f_[16][pairs], y_end_[pairs], at_[pairs];
};

// The polynomial as CVODE's Nordsieck history at the end of the step, as if it had taken equal steps of size h. CVODE
// computes z_1 again from f; its growth after a first step, 1e4 times, is that of any other step here.
template <int pairs>
void hand_over(CVodeMemRec& m, const StatePair (*p)[pairs], double share, double h) {
  double factor = 1;
  for (int j = 0; j <= start_order; ++j, factor *= share)
    for (int i = 0; i < pairs; ++i) state_pairs(m.cv_zn[j])[i] = factor * p[j][i];
  m.cv_q = start_order;
  m.cv_L = m.cv_qwait = start_order + 1;
  m.cv_hin = m.cv_h = h;
  std::fill_n(m.cv_tau, L_MAX + 1, h);
  m.cv_etamax = m.cv_eta_max_es;
}

template <int pairs>
bool start_with(Integrator::Implementation& self) {
  StartStep<pairs> step(self);
  if (!step.evaluate_start()) return false;
  auto& m = *static_cast<CVodeMem>(self.cvode);
  Progress& progress = self.progress;
  const double t = progress.known_until, room = m.cv_tstopset ? m.cv_tstop - t : INFINITY;
  const double longest = std::fmin(room, self.system.longest_step);
  double h = std::fmin(longest, progress.start_size > 0 ? progress.start_size : step.guess_size());
  for (int attempts = 0;; ++attempts) {
    if (attempts == most_attempts || t + h == t) return false;
    const double error = step.attempt(h);
    const double liked = h * std::fmin(10, std::fmax(0.2, 0.9 * std::pow(error, -1.0 / 8)));
    progress.start_size = h == room && error <= 1 ? std::fmax(progress.start_size, liked) : liked;
    if (error <= 1) break;
    h = std::fmin(longest, progress.start_size);
  }
  StatePair p[start_order + 1][pairs];
  if (!step.evaluate_interior()) return false;
  step.expand_at_end(p);
  const double share = std::fmin(1, adams_share * progress.start_size / h);
  std::memcpy(state_pairs(self.y), p[0], sizeof *p);
  if (CVodeReInit(self.cvode, h == room ? m.cv_tstop : t + h, self.y) != CV_SUCCESS) return false;
  if (h == room) m.cv_tstopset = SUNFALSE;  // reached
  hand_over<pairs>(m, p, share, share * h);
  progress.step_start = t;
  progress.trend = {};
  progress.known_until = m.cv_tn;
  return true;
}

}  // namespace

bool has_history(const CVodeMemRec& m) { return m.cv_nst > 0 || m.cv_q > 1; }

void fit_before_stop(CVodeMemRec& m) {
  if (!m.cv_tstopset) return;
  const double room = m.cv_tstop - m.cv_tn;
  if (!has_history(m)) {
    if (room < 4 * m.cv_uround * m.cv_tstop) m.cv_hin = room;
    return;
  }
  if (m.cv_tn + m.cv_hin <= m.cv_tstop) return;
  const double h = room * (1 - 4 * m.cv_uround), shorter = h / m.cv_hin;
  double factor = shorter;
  for (int j = 1; j <= m.cv_q; ++j, factor *= shorter) state_scale(factor, m.cv_zn[j], m.cv_zn[j]);
  m.cv_hin = m.cv_h = h;
}

bool start_high(Integrator::Implementation& self) {
  return self.system.states == 8 ? start_with<4>(self) : start_with<6>(self);
}

}  // namespace integrator
