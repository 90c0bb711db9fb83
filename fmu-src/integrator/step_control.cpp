// Step control with a memory of one step.
//
// CVODE sizes the next step as if the error constant stayed what it was. Along the wheel's motion it changes by up to
// six times a step, and one step in seven fails at tolerance 1e-6. Here half of the last change is expected again:
//   eta = (bias e sqrt(e / e_last))^(-1/L) sqrt(h / h_last),   e the error of the step in units of the tolerance, L the
// order plus one (Gustafsson, ACM TOMS 20 (1994) 496: predictive step control). Measured in
// docs/results/work_precision.md.
#include "step_control.hpp"

#include <algorithm>
#include <cmath>

namespace integrator {

void follow_trend(CVodeMemRec& m, Trend* trend) {
  // An error below the least one, as after a step cut short, says no more; the greatest change bounds what it asks for.
  constexpr double bias = 4, least_error = 1e-10, greatest_change = 10;
  const Trend last = *trend;
  const double error = std::fmax(m.cv_acnrm * m.cv_tq[2], least_error);
  *trend = {error, m.cv_hu, m.cv_qu};
  if (last.order != m.cv_qu || m.cv_qprime != m.cv_qu) return;
  const double foreseen = bias * error * std::sqrt(error / last.error);
  const double eta = std::sqrt(m.cv_hu / last.size) / std::pow(foreseen, 1.0 / (m.cv_qu + 1));
  m.cv_eta = std::clamp(eta, 1 / greatest_change, std::fmin(greatest_change, 1 / (m.cv_h * m.cv_hmax_inv)));
  m.cv_hprime = m.cv_h * m.cv_eta;
}

}  // namespace integrator
