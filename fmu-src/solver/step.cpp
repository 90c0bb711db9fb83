// The dense output, the same for all engines.
#include "step.hpp"

#include <algorithm>

namespace solver {
void Step::set_point(double t, const double* y, int states) {
  start = end = t;
  least_margin = never;
  inside_at = 0;
  degree = 0;
  std::copy_n(y, states, y_start);
  std::copy_n(y_start, states, y_end);
}

void Step::visit(support::Archive& archive, int states) {
  if (archive.reads()) degree = unknown;
  archive.number(start);
  archive.range(end, start, archive.greatest);
  archive.numbers(y_start, states);
  archive.numbers(y_end, states);
  archive.range(least_margin, -archive.greatest, never);
  archive.range(inside_at, 0, 1);
  archive.numbers(y_inside, states);
}

void Step::read(double t, int first, int count, double* y) const {
  const double rounding = rounding_at(t), s = (t - end) / (end - start);
  if (t >= end - rounding)
    std::copy_n(y_end + first, count, y + first);
  else if (t <= start + rounding)
    std::copy_n(y_start + first, count, y + first);
  else if (count == 1)
    evaluate<1>(c, degree, s, y + first, first);
  else
    count == 8 ? evaluate<8>(c, degree, s, y) : evaluate<max_states>(c, degree, s, y);
}

}  // namespace solver
