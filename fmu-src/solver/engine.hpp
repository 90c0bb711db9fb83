// What makes the steps: one interface for all methods.
//
// An engine keeps what it needs from step to step; the step itself and its dense output belong to the solver.
#pragma once

#include "bytes.hpp"
#include "step.hpp"

namespace solver {

class Engine {
 public:
  // The next step starts anew. False where the engine could not be set up: failure().
  virtual bool start(const Problem& problem) = 0;

  // One step from the end of the last one, which `step` is moved to, up to `stop` (s) at the latest. False where none
  // is accepted: failure() gives the reason.
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
