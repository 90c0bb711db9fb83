// A set of pointers behind a spin lock: an open hash table that doubles. Only the rare calls look into it.
#include "registry.hpp"

#include <cstdint>
#include <cstdlib>

#include "spin_lock.hpp"

namespace fmi {
namespace {

using integrator::SpinLock;

struct Table {
  const void** slots = nullptr;
  std::size_t capacity = 0, used = 0;  // capacity is a power of two; `used` counts live entries

  std::size_t slot_of(const void* p) const {
    const auto key = reinterpret_cast<std::uintptr_t>(p);
    std::size_t i = (key >> 4u) * 0x9e3779b97f4a7c15u & (capacity - 1);
    while (slots[i] && slots[i] != p) i = (i + 1) & (capacity - 1);
    return i;
  }
  bool contains(const void* p) const { return capacity && slots[slot_of(p)] == p; }

  bool rebuild(std::size_t new_capacity) {
    Table next;
    next.slots = static_cast<const void**>(std::calloc(new_capacity, sizeof(void*)));
    if (!next.slots) return false;
    next.capacity = new_capacity;
    for (std::size_t i = 0; i < capacity; ++i)
      if (slots[i]) next.slots[next.slot_of(slots[i])] = slots[i];
    std::free(slots);
    slots = next.slots;
    capacity = new_capacity;
    return true;
  }
  bool insert(const void* p) {
    if (2 * (used + 1) > capacity && !rebuild(capacity ? 2 * capacity : 16)) return false;
    slots[slot_of(p)] = p;
    ++used;
    return true;
  }
  // Closes the gap, so that no search stops early at the freed slot.
  void erase(const void* p) {
    std::size_t gap = slot_of(p);
    slots[gap] = nullptr;
    for (std::size_t i = (gap + 1) & (capacity - 1); slots[i]; i = (i + 1) & (capacity - 1)) {
      const void* moved = slots[i];
      slots[i] = nullptr;
      slots[slot_of(moved)] = moved;
    }
    if (--used == 0) {
      std::free(slots);
      *this = {};
    }
  }
};

std::atomic_flag taken;  // guards the table
Table table;

}  // namespace

bool remember_instance(const void* instance) {
  const SpinLock lock(taken);
  return table.insert(instance);
}

bool is_live_instance(const void* instance) {
  const SpinLock lock(taken);
  return table.contains(instance);
}

bool forget_instance(const void* instance) {
  const SpinLock lock(taken);
  if (!table.contains(instance)) return false;
  table.erase(instance);
  return true;
}

}  // namespace fmi
