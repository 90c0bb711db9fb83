// DOP853: the Runge-Kutta pair of Dormand and Prince, order 8, dense output of order 7 (dormand_prince.hpp), of
// problems of eight states.
//
// Nothing is kept from step to step except the wanted size of the next one: a restart is free and a snapshot is a copy.
#pragma once

#include "step.hpp"

namespace solver {

class RungeKutta final : public Engine {
 public:
  // The size of the first step is the one wanted last, or a guess from state and tolerance.
  bool start(const Problem& problem) override;
  bool advance(const Problem& problem, double stop, Counters* counters, Step* step) override;

  // Makes the evaluations that only the dense output needs: three, and that at the end of a step that ends at a stop or
  // at the limit of a first step, where most often the problem changes. The next step does not use them, so that it
  // costs the same whatever was read.
  void expand(const Problem& problem, Step* step) override;
  void visit(support::Archive& archive, const Problem& problem, const Step& step) override;
  // What is kept while another engine steps.
  void visit_size(support::Archive& archive) { archive.range(liked_, 0, archive.greatest); }

  // Whether the steep state hardly moved in the last step, yet its decay, not the motion, limited the step.
  bool rests() const { return rests_; }

  // The first step after the last start is at most dt, s.
  void limit_first_step(double dt) { limit_ = dt; }

 private:
  struct Work;

  double liked_ = 0;                           // size of the next step, s; 0: none was made
  double limit_ = 0;                           // of the first step after the last start, s; 0: none
  double size_ = 0;                            // of the last step, s
  double last_error_ = 0;                      // of the last step, in units of the weights; 0: there was none
  double end_margin_ = 0;                      // least margin at the end of the last step
  bool rests_ = false;                         // see rests()
  bool has_end_ = false;                       // stage 12, at the end of the last step, is known
  alignas(16) double f_[16][max_states] = {};  // rates at the stages of the last step
};

}  // namespace solver
