// Pointers that this library handed out and that a master passes back. A faulty master passes one twice, one that is
// already freed, or one that never was handed out. An FMU state is touched only if its registry holds it; an instance
// is looked up where it is freed, terminated or reset.
#pragma once

#include <atomic>
#include <cstddef>

namespace fmi {

// A set of pointers, an open hash table that doubles, behind a spin lock: instances may live in many threads.
class Registry {
 public:
  // False if there is no memory.
  bool add(const void* pointer);
  bool holds(const void* pointer);
  // False if it was not held.
  bool remove(const void* pointer);

 private:
  std::size_t slot_of(const void* pointer) const;
  bool contains(const void* pointer) const;
  bool rebuild(std::size_t capacity);

  std::atomic_flag taken_;
  const void** slots_ = nullptr;
  std::size_t capacity_ = 0, used_ = 0;  // capacity is a power of two; `used_` counts live entries
};

extern Registry instances, fmu_states;

}  // namespace fmi
