// A set of pointers as an array without order.
#include "registry.hpp"

#include <algorithm>
#include <cstdlib>
#include <mutex>

namespace fmi {

void SpinLock::lock() {
  while (taken_.test_and_set(std::memory_order_acquire)) {
  }
}

constinit Registry instances, fmu_states;

bool Registry::add(const void* pointer) {
  const std::lock_guard guard(lock_);
  if (used_ == capacity_) {
    const std::size_t capacity = std::max<std::size_t>(8, 2 * capacity_);
    auto** const larger = static_cast<const void**>(std::calloc(capacity, sizeof *held_));
    if (!larger) return false;
    std::copy_n(held_, used_, larger);
    std::free(held_);
    held_ = larger;
    capacity_ = capacity;
  }
  held_[used_++] = pointer;
  return true;
}

bool Registry::holds(const void* pointer) {
  const std::lock_guard guard(lock_);
  return place_of(pointer) < used_;
}

// With the last pointer the array is freed too.
bool Registry::remove(const void* pointer) {
  const std::lock_guard guard(lock_);
  const std::size_t place = place_of(pointer);
  if (place == used_) return false;
  held_[place] = held_[--used_];
  if (used_ > 0) return true;
  std::free(held_);
  held_ = nullptr;
  capacity_ = 0;
  return true;
}

// used_ where it is not held. The latest are looked at first: states are most often returned soon.
std::size_t Registry::place_of(const void* pointer) const {
  for (std::size_t place = used_; place-- > 0;)
    if (held_[place] == pointer) return place;
  return used_;
}

}  // namespace fmi
