// What this library handed out and a master passes back. A faulty master passes a pointer twice, one that is already
// freed, or one that never was handed out. An FMU state is touched only if its registry holds it; an instance is looked
// up where it is freed, terminated or reset.
#pragma once

#include <atomic>
#include <mutex>

namespace fmi {

// Held for a few microseconds, by rare calls only. It needs neither memory nor the operating system.
class SpinLock {
 public:
  void lock() {
    while (taken_.test_and_set(std::memory_order_acquire)) continue;
  }
  void unlock() { taken_.clear(std::memory_order_release); }

 private:
  std::atomic_flag taken_;
};

// Of something that is handed out, by the address of this part.
struct Held {
  Held* next = nullptr;
};

// A list, the latest first, behind a spin lock: instances may live in many threads.
class Registry {
 public:
  void add(Held* one) {
    const std::lock_guard guard(lock_);
    one->next = first_;
    first_ = one;
  }
  // Null where it is not held.
  Held* find(const void* pointer) {
    const std::lock_guard guard(lock_);
    return *link_to(pointer);
  }
  Held* remove(const void* pointer) {
    const std::lock_guard guard(lock_);
    Held** const link = link_to(pointer);
    Held* const found = *link;
    if (found) *link = found->next;
    return found;
  }

 private:
  Held** link_to(const void* pointer) {
    Held** link = &first_;
    while (*link && *link != pointer) link = &(*link)->next;
    return link;
  }

  SpinLock lock_;
  Held* first_ = nullptr;
};

inline constinit Registry instances, fmu_states;

}  // namespace fmi
