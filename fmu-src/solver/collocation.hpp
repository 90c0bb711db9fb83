// Collocation at the six points of Radau IIA, order 11: for a problem in which one state or two settle, however fast
// (Problem::steep and turning). The error of the polynomial is kept below the tolerance; that at the end of the step,
// of order 11, is far smaller.
//
// From step to step it keeps the wanted size of the next step, and the rates of the last one, which predict the next.
#pragma once

#include "step.hpp"

namespace solver {

inline constexpr int radau_points = 6;

class Collocation final : public Engine {
 public:
  bool start(const Problem& problem) override {
    known_ = false;
    liked_ = std::fmin(problem.first_step, problem.longest_step);
    return true;
  }
  void limit_first_step(double dt) { liked_ = std::fmin(liked_, dt); }
  bool advance(const Problem& problem, double stop, Counters* counters, Step* step) override;
  void expand(const Problem& problem, Step* step) override;
  void visit(support::Archive& archive, const Problem& problem, const Step& step) override;

 private:
  Step last_step(const Problem& problem, double end);
  bool predict(const Problem& problem, const Step& last, Counters* counters, Step* step);
  double try_size(const Problem& problem, const double* weights, bool predicted, Counters* counters, Step* step);
  bool size_up(const Problem& problem, double stop, double shortest, Step* step);
  void like(const Problem& problem, double error, int attempts, bool stops, const Step& step);
  struct Newtons;
  void prepare(const Problem& problem, const Step& step, Newtons* newtons) const;
  double sweep(const Problem& problem, const double* weights, const Newtons& newtons, Counters* counters, Step* step);

  double liked_ = 0, size_ = 0;              // size of the next step and of the last, s
  bool known_ = false;                       // the rates are those of the last step
  double f_[radau_points][max_states] = {};  // at its points
};

}  // namespace solver
