// CVODE of SUNDIALS: Adams for smooth motion, backward differentiation (BDF) for stiff motion.
//
// Its public interface alone; cvode_history.cpp is the exception, and can go with nothing lost but snapshots.
#pragma once

#include <cstddef>

#include "step.hpp"

namespace solver {

struct CvodeObjects;

class Cvode {
 public:
  Cvode() = default;
  Cvode(const Cvode&) = delete;
  Cvode& operator=(const Cvode&) = delete;
  ~Cvode() { free_objects(); }

  // From y at t. SUNDIALS's objects are made at the first start of a method. False where they could not be.
  bool start(const Problem& problem, Method method, double t, const double* y, Step* step);

  // One step that ends at `stop` (s) at the latest. False where CVODE gives up: failure() says why.
  bool advance(const Problem& problem, double stop, Counters* counters, Step* step);

  // The polynomial of the step, if it is not known yet.
  void expand(int states, Step* step) const;

  const char* failure() const { return failure_; }

  // The history after the last step (cvode_history.cpp); objects of the same method and number of states.
  template <class Archive>
  void visit(Archive& archive, int states);
  // Makes the objects of a solver that is to be restored.
  bool prepare_restore(const Problem& problem, Method method, Step* step);

 private:
  bool make_objects(int states, Method method);
  void free_objects();
  bool restart(double t, const double* y);

  CvodeObjects* objects_ = nullptr;
  int starts_anew_ = 1;  // 1: the next step is the first; 2: it is, because the last one ended at a stop; 0: it is not
  char failure_[160] = "";
};

}  // namespace solver
