// What is handed out to a master, which passes it back: instances and FMU states. Each begins with the mark of its
// kind, so that a call checks a pointer without a list of all that are alive.
#pragma once

#include <bit>
#include <cstdint>
#include <cstdlib>

namespace fmi {

struct Handle {
  // Some masters pass a state where its address belongs; what they free is this null pointer.
  const void* none = nullptr;
  volatile std::uint64_t mark;  // else compilers drop the store that wipes it before the memory is freed
};

// Null unless the pointer is one of this kind. If not null, it must point to memory that can be read.
template <class Handled>
Handled* handle_of(void* passed) {
  auto* const handle = static_cast<Handle*>(passed);
  if (!handle || std::bit_cast<std::uintptr_t>(handle) % alignof(Handle) != 0) return nullptr;
  return handle->mark == Handled::own_mark ? static_cast<Handled*>(handle) : nullptr;
}

template <class Handled>
void release(Handled* handle) {
  handle->mark = 0;
  handle->~Handled();
  std::free(handle);
}

}  // namespace fmi
