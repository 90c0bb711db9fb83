// Where a watched function falls below zero on the dense output of one step: its first fall, dips included.
#pragma once

#include <optional>

#include "step.hpp"

namespace solver {

struct Sample {
  double t, g;
};

class Search {
 public:
  // roots: counts the evaluations of the function.
  Search(const Problem& problem, const Step& step, const Watched& watched, long long* roots)
      : problem_(problem), step_(step), watched_(watched), roots_(roots) {}

  Sample sample(double t) const;
  Sample sample(double t, const double* y) const {
    ++*roots_;
    return {t, watched_.value(problem_.owner, watched_.event, t, y)};
  }

  // The first instant in [lo.t, hi.t] at which g is below zero, if there is one. lo.g below zero: lo.t.
  std::optional<double> find_first_fall(Sample lo, Sample hi) const;

  // Whether g, known at three instants, is so far above zero that it cannot fall below it between them.
  static bool stays_above(Sample lo, Sample inside, Sample hi);

 private:
  struct Fall {
    Sample before, below;
  };
  std::optional<Fall> look(Sample lo, Sample mid, Sample hi, int depth, int* budget) const;
  double fall_through(Sample lo, Sample hi) const;

  const Problem& problem_;
  const Step& step_;
  const Watched& watched_;
  long long* roots_;
};

}  // namespace solver
