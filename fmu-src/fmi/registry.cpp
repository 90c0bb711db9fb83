// A set of pointers as a sorted array.
#include "registry.hpp"

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <mutex>

namespace fmi {

void SpinLock::lock() {
  while (taken_.test_and_set(std::memory_order_acquire)) {
  }
}

constinit Registry instances, fmu_states;

// Where the pointer is, or where it would be put.
std::size_t Registry::place_of(const void* pointer) const {
  return static_cast<std::size_t>(std::lower_bound(sorted_, sorted_ + used_, pointer, std::less<>()) - sorted_);
}

bool Registry::contains(const void* pointer) const {
  const std::size_t place = place_of(pointer);
  return place < used_ && sorted_[place] == pointer;
}

bool Registry::add(const void* pointer) {
  const std::lock_guard guard(lock_);
  if (used_ == capacity_) {
    const std::size_t capacity = std::max<std::size_t>(8, 2 * capacity_);
    auto** const larger = static_cast<const void**>(std::calloc(capacity, sizeof *sorted_));
    if (!larger) return false;
    std::copy_n(sorted_, used_, larger);
    std::free(sorted_);
    sorted_ = larger;
    capacity_ = capacity;
  }
  const void** const place = sorted_ + place_of(pointer);
  std::copy_backward(place, sorted_ + used_, sorted_ + used_ + 1);
  *place = pointer;
  ++used_;
  return true;
}

bool Registry::holds(const void* pointer) {
  const std::lock_guard guard(lock_);
  return contains(pointer);
}

// With the last pointer the array is freed too.
bool Registry::remove(const void* pointer) {
  const std::lock_guard guard(lock_);
  if (!contains(pointer)) return false;
  const void** const place = sorted_ + place_of(pointer);
  std::copy(place + 1, sorted_ + used_, place);
  if (--used_ > 0) return true;
  std::free(sorted_);
  sorted_ = nullptr;
  capacity_ = 0;
  return true;
}

}  // namespace fmi
