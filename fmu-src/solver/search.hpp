// Where a watched function falls below zero on the dense output of one step: its first fall, dips included.
#pragma once

#include <optional>
#include <span>

#include "step.hpp"

namespace solver {

struct Sample {
  double t, g;
};

struct Search {
  const Problem& problem;
  const Step& step;
  const Watched& watched;
  std::span<const double> extremes;  // of a prescribed input inside the step, ascending
  long long* roots;                  // counts the evaluations of the function

  Sample sample(double t) const;
  Sample sample(double t, const double* y) const {
    ++*roots;
    return {t, watched.value(problem.owner, watched.event, t, y)};
  }

  // (lo, hi) => the first instant in [lo.t, hi.t] at which g is below zero, if there is one. lo.g below zero: lo.t. No
  // extreme lies before lo.t.
  std::optional<double> find_first_fall(Sample lo, Sample hi) const;

  // (three samples) => whether g is so far above zero that it cannot fall below it between them
  static bool stays_above(Sample lo, Sample inside, Sample hi);

 private:
  struct Fall {
    Sample before, below;
  };
  std::optional<Fall> look(Sample lo, Sample mid, Sample hi, int depth, int* budget) const;
  double fall_through(Sample lo, Sample hi) const;
};

}  // namespace solver
