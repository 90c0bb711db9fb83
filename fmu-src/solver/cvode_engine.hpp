// CVODE of SUNDIALS: Adams for smooth motion, backward differentiation (BDF) for stiff motion.
//
// Through its public interface only; snapshots, cvode_history.cpp, are the exception.
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
  static void free_objects(CvodeObjects* objects);

  const Method method_;  // adams or bdf
  std::unique_ptr<CvodeObjects, void (*)(CvodeObjects*)> objects_{nullptr, free_objects};
  // The next step goes on from the last one, or is the first after a start, or after a stop or a failure of the
  // history.
  enum class Next { goes_on, starts, starts_after_stop } next_ = Next::starts;
};

}  // namespace solver
