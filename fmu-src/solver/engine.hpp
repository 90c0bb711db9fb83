// What makes the steps: one interface for all methods.
//
// An engine keeps what it needs from step to step; the step itself and its dense output belong to the solver.
#pragma once

#include "bytes.hpp"
#include "step.hpp"

namespace solver {

class Engine {
 public:
  // From y at t. False where the engine could not be set up: failure().
  virtual bool start(const Problem& problem, double t, const double* y, Step* step) = 0;

  // One step that ends at `stop` (s) at the latest. False where no step is accepted: failure() says why.
  virtual bool advance(const Problem& problem, double stop, Counters* counters, Step* step) = 0;

  // The polynomial of the step, which is not known yet.
  virtual void expand(const Problem& problem, Counters* counters, Step* step) = 0;

  // All that is needed to go on after the step, saved or read; `active`: the step is this engine's. What is read and
  // could not belong to the step is refused.
  virtual void visit(support::Archive& archive, const Problem& problem, Step* step, bool active) = 0;

  const char* failure() const { return failure_; }

 protected:
  ~Engine() = default;
  const char* failure_ = nullptr;
};

}  // namespace solver
