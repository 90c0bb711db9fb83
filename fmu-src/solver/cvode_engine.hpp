// CVODE of SUNDIALS: Adams for smooth motion, backward differentiation (BDF) for stiff motion.
//
// Through its public interface only. cvode_history.cpp is the exception; without it only snapshots of CVODE runs would
// be lost.
#pragma once

#include "step.hpp"

namespace support {
struct Measure;
struct Reader;
struct Writer;
}  // namespace support

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

  // The next step is the first after a start (1) or after a stop (2); else 0.
  int& starts_anew() { return starts_anew_; }

  // The history after the last step, which has a length (cvode_history.cpp). restore is given the step, and refuses
  // numbers that could not belong to it.
  void measure(support::Measure& measure);
  void save(support::Writer& writer);
  bool restore(const Problem& problem, Method method, Step* step, support::Reader& reader);

 private:
  bool make_objects(int states, Method method);
  void free_objects();
  bool restart(double t, const double* y);
  template <class Archive>
  void visit_history(Archive& archive);

  CvodeObjects* objects_ = nullptr;
  int starts_anew_ = 1;
  const char* failure_ = nullptr;
};

}  // namespace solver
