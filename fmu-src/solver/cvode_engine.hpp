// CVODE of SUNDIALS: Adams for smooth motion, backward differentiation (BDF) for stiff motion.
//
// Through its public interface only; snapshots, cvode_history.cpp, are the exception.
#pragma once

#include "engine.hpp"

namespace solver {

struct CvodeObjects;

class Cvode final : public Engine {
 public:
  explicit Cvode(Method method) : method_(method) {}
  Cvode(const Cvode&) = delete;
  Cvode& operator=(const Cvode&) = delete;
  ~Cvode() { free_objects(); }

  // SUNDIALS's objects are made at the first start.
  bool start(const Problem& problem) override;
  bool advance(const Problem& problem, double stop, Counters* counters, Step* step) override;
  void expand(const Problem& problem, Counters* counters, Step* step) override;
  void visit(support::Archive& archive, const Problem& problem, Step* step, bool active) override;

 private:
  bool make_objects(int states);
  void free_objects();
  // cvode_history.cpp
  bool imitate_step(const Problem& problem, const Step& step);
  bool fits(const Step& step) const;

  const Method method_;  // adams or bdf
  CvodeObjects* objects_ = nullptr;
  // The next step goes on from the last one, or is the first after a start, or after a stop or a failure of the
  // history.
  enum class Next { goes_on, starts, starts_after_stop } next_ = Next::starts;
};

}  // namespace solver
