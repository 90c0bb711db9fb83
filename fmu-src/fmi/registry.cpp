// A set of pointers with linear probing.
#include "registry.hpp"

#include <cstdint>
#include <cstdlib>

namespace fmi {
namespace {

// Held for a few microseconds, by rare calls only. It needs neither memory nor the operating system.
class SpinLock {
 public:
  explicit SpinLock(std::atomic_flag& taken) : taken_(taken) {
    while (taken_.test_and_set(std::memory_order_acquire)) {
    }
  }
  ~SpinLock() { taken_.clear(std::memory_order_release); }
  SpinLock(const SpinLock&) = delete;
  SpinLock& operator=(const SpinLock&) = delete;

 private:
  std::atomic_flag& taken_;
};

}  // namespace

constinit Registry instances, fmu_states;

// Where the pointer is, or where it would be put. Needs a free slot.
std::size_t Registry::slot_of(const void* pointer) const {
  const auto key = reinterpret_cast<std::uintptr_t>(pointer);
  std::size_t i = (key >> 4u) * 0x9e3779b97f4a7c15u & (capacity_ - 1);
  while (slots_[i] && slots_[i] != pointer) i = (i + 1) & (capacity_ - 1);
  return i;
}

bool Registry::contains(const void* pointer) const {
  return pointer && capacity_ && slots_[slot_of(pointer)] == pointer;
}

bool Registry::rebuild(std::size_t capacity) {
  auto** slots = static_cast<const void**>(std::calloc(capacity, sizeof(void*)));
  if (!slots) return false;
  const void** const old = slots_;
  const std::size_t old_capacity = capacity_;
  slots_ = slots;
  capacity_ = capacity;
  for (std::size_t i = 0; i < old_capacity; ++i)
    if (old[i]) slots_[slot_of(old[i])] = old[i];
  std::free(old);
  return true;
}

bool Registry::add(const void* pointer) {
  const SpinLock lock(taken_);
  if (2 * (used_ + 1) > capacity_ && !rebuild(capacity_ ? 2 * capacity_ : 16)) return false;
  slots_[slot_of(pointer)] = pointer;
  ++used_;
  return true;
}

bool Registry::holds(const void* pointer) {
  const SpinLock lock(taken_);
  return contains(pointer);
}

// Closes the gap, so that no search stops early at the freed slot. With the last pointer the table is freed too.
bool Registry::remove(const void* pointer) {
  const SpinLock lock(taken_);
  if (!contains(pointer)) return false;
  const std::size_t gap = slot_of(pointer);
  slots_[gap] = nullptr;
  for (std::size_t i = (gap + 1) & (capacity_ - 1); slots_[i]; i = (i + 1) & (capacity_ - 1)) {
    const void* moved = slots_[i];
    slots_[i] = nullptr;
    slots_[slot_of(moved)] = moved;
  }
  if (--used_ > 0) return true;
  std::free(slots_);
  slots_ = nullptr;
  capacity_ = 0;
  return true;
}

}  // namespace fmi
