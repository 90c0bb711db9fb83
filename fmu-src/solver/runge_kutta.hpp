// DOP853: the Runge-Kutta pair of Dormand and Prince, order 8, dense output of order 7 (dormand_prince.hpp).
//
// Nothing is kept from step to step except the wanted size of the next one: a restart is free and a snapshot is a copy.
#pragma once

#include "step.hpp"

namespace solver {

class RungeKutta {
 public:
  // From y at t. The size of the first step is the one wanted last, or a guess from state and tolerance.
  void start(double t, const double* y, int states, Step* step);

  // The first step after the next start is at most dt, s.
  void limit_first_step(double dt) { next_limit_ = dt; }

  // One step that ends at `stop` (s) at the latest. False where no step is accepted: failure() says why.
  bool advance(const Problem& problem, double stop, Counters* counters, Step* step);

  // The polynomial of the step, if it is not known yet. A step that ends at a stop or at the limit of a first step
  // leaves out the four evaluations that only the dense output and the next step need: most often the problem changes
  // there, and nothing in it is read. The next step does not use them, so that it costs the same whatever was read.
  void expand(const Problem& problem, Counters* counters, Step* step);

  const char* failure() const { return failure_; }

  // All that is needed to go on; `rates` holds the evaluations of the last step that were made, 0, 12 or 16.
  template <class Archive>
  void visit(Archive& archive, int states);
  // Whether the restored numbers are those of the step, to the bit; then the step has its polynomial again.
  bool fits(const Problem& problem, Step* step);

 private:
  template <int width>
  class Attempt;
  template <int width>
  bool advance_wide(const Problem& problem, double stop, Counters* counters, Step* step);
  template <int width>
  const char* accept_step(Attempt<width>& attempt, double longest, double stop, double* liked, Step* step);

  double next_size(double h, double error);

  double liked_[2] = {};               // size of the next step, s, outside of passages and inside; 0: none was made
  double limit_ = 0, next_limit_ = 0;  // of the first step after the last and the next start, s; 0: none
  double size_ = 0;                    // of the last step, s
  double last_error_ = 0;              // of the last step, in units of the weights; 0: there was none
  double margin_ = 0;                  // at the end of the last step
  int rates_ = 0;                      // evaluations of the last step that the next one knows
  alignas(16) double f_[16][max_states] = {};
  const char* failure_ = nullptr;
};

template <class Archive>
void RungeKutta::visit(Archive& archive, int states) {
  for (double& size : liked_) archive.range(size, 0, archive.greatest);
  archive.range(limit_, 0, archive.greatest);
  archive.range(next_limit_, 0, archive.greatest);
  archive.range(size_, 0, archive.greatest);
  archive.range(last_error_, 0, 1);
  archive.number(margin_);
  archive.count(rates_, 0, 16);
  for (int k = 0; k < rates_; ++k) archive.numbers(f_[k], states);
}

}  // namespace solver
