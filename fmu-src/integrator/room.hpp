// The room of one solver while it is furnished: every object of the solver is made in it, nothing is freed singly.
#pragma once

#include "integrator.hpp"
#include "spin_lock.hpp"

extern "C" {
#include "room.h"
}

namespace integrator {

// While one lives, allocations of SUNDIALS come from `room`. One at a time in the process: others wait some
// microseconds. Not a thread-local pointer, because its memory is itself allocated at first use, and a failure of that
// ends the process.
class Furnishing {
 public:
  explicit Furnishing(Room& room);
  ~Furnishing();

 private:
  SpinLock lock_;
};

}  // namespace integrator
