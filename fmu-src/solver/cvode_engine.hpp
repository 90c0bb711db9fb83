// CVODE of SUNDIALS: Adams for smooth motion, backward differentiation (BDF) for stiff motion.
//
// Through its public interface only. A snapshot holds the last start and the number of steps since then, which are made
// again when it is restored: CVODE has no call for its history.
#pragma once

#include <memory>

#include "step.hpp"

namespace solver {

struct CvodeObjects;

class Cvode final : public Engine {
 public:
  explicit Cvode(Method method) : method_(method) {}

  // SUNDIALS's objects are made at the first start.
  bool start(const Problem& problem) override;
  bool advance(const Problem& problem, double stop, Counters* counters, Step* step) override;
  void expand(const Problem& problem, Step* step) override;
  void visit(support::Archive& archive, const Problem& problem, const Step& step) override;

 private:
  // A solution of more steps starts anew, so that to restore one takes at most some ten milliseconds.
  static constexpr int most_steps = 10000;

  static void free_objects(CvodeObjects* objects);
  int start_at(const Step& step);
  int make_step(double stop, double* t);

  const Method method_;  // adams or bdf
  std::unique_ptr<CvodeObjects, void (*)(CvodeObjects*)> objects_{nullptr, free_objects};
  // The next step goes on from the last one, or is the first after a start, or after a stop.
  enum class Next { goes_on, starts, starts_after_stop } next_ = Next::starts;
  double start_ = 0, y_start_[max_states] = {};  // s, where the solution last started from nothing
  int steps_ = 0;                                // since then
};

}  // namespace solver
