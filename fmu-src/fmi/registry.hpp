// Pointers that this library handed out and that a master passes back. A faulty master passes one twice, one that is
// already freed, or one that never was handed out. An FMU state is touched only if its registry holds it; an instance
// is looked up where it is freed, terminated or reset.
#pragma once

#include <atomic>
#include <cstddef>

namespace fmi {

// Held for a few microseconds, by rare calls only. It needs neither memory nor the operating system.
class SpinLock {
 public:
  void lock();
  void unlock() { taken_.clear(std::memory_order_release); }

 private:
  std::atomic_flag taken_;
};

// A set of pointers, an array that doubles, behind a spin lock: instances may live in many threads.
class Registry {
 public:
  // False if there is no memory.
  bool add(const void* pointer);
  bool holds(const void* pointer);
  // False if it was not held.
  bool remove(const void* pointer);

 private:
  std::size_t place_of(const void* pointer) const;

  SpinLock lock_;
  const void** held_ = nullptr;
  std::size_t capacity_ = 0, used_ = 0;
};

extern Registry instances, fmu_states;

}  // namespace fmi
