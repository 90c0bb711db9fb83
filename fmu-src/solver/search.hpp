// Where a watched function falls below zero on the dense output of one step: its first fall, dips included.
#pragma once

#include "step.hpp"

namespace solver {

using Watched = double (*)(void* owner, double t, const double* y);

struct Sample {
  double t, g;
};

class Search {
 public:
  // Watches sign * g. roots: counts the evaluations of g.
  Search(const Problem& problem, const Step& step, Watched g, long long* roots, double sign = 1)
      : problem_(problem), step_(step), g_(g), roots_(roots), sign_(sign) {}

  double value(double t) const;

  // The first instant in [lo.t, hi.t] at which g is below zero; false where there is none. lo.g below zero: lo.t.
  bool find_first_fall(Sample lo, Sample hi, double* t) const;

  // Whether g, known at three instants, is so far above zero that it cannot fall below it between them.
  static bool stays_above(Sample lo, Sample inside, Sample hi);

 private:
  bool look(Sample lo, Sample mid, Sample hi, int depth, int* budget, Sample bracket[2]) const;
  double fall_through(Sample lo, Sample hi) const;
  Sample sample(double t) const { return {t, value(t)}; }

  const Problem& problem_;
  const Step& step_;
  Watched g_;
  long long* roots_;
  double sign_;
};

}  // namespace solver
