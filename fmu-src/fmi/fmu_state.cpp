// FMI 2.0 functions: rollback. An FMU state is its serialization: portable bytes that hold no pointers.
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <new>

#include "instance.hpp"
#include "snapshot.hpp"

using fmi::guarded, fmi::handle_of, fmi::Instance, fmi::no_fault;
namespace legality = fmi::legality;

namespace {

struct Snapshot : fmi::Handle {
  static constexpr std::uint64_t kind_mark = 0x535f554d46484557;  // "WEHFMU_S"

  std::size_t size;  // of the bytes behind this header
  unsigned char* bytes() { return reinterpret_cast<unsigned char*>(this + 1); }
};

// A state of `size` bytes: the previous one where its size fits, else a new one, and the previous one is freed. A
// pointer to something else counts as none. Null without memory: then the previous one is kept.
Snapshot* allocate(fmi2FMUstate* state, std::size_t size) {
  auto* const old = handle_of<Snapshot>(*state);
  if (old && old->size == size) return old;
  void* const memory = std::malloc(sizeof(Snapshot) + size);
  if (!memory) return nullptr;
  if (old) fmi::release(old);
  auto* const snapshot = ::new (memory) Snapshot{{.mark = Snapshot::kind_mark}, size};
  *state = static_cast<fmi::Handle*>(snapshot);
  return snapshot;
}

constexpr const char *null_pointer = "the state, the size or the bytes are a null pointer",
                     *unknown_state = "this FMU did not create the state", *no_memory = "out of memory";

// (state, its other arguments are no null pointers, body) => a call that reads a state; the body returns what is wrong.
template <class Body>
auto with_state(fmi2FMUstate state, bool complete, Body body) {
  return [=](Instance& i) {
    auto* const snapshot = handle_of<Snapshot>(state);
    return !state || !complete ? null_pointer : snapshot ? body(i, *snapshot) : unknown_state;
  };
}

}  // namespace

fmi2Status fmi2GetFMUstate(fmi2Component c, fmi2FMUstate* state) {
  return guarded(c, legality::always, [=](Instance& i) {
    if (!state) return null_pointer;
    Snapshot* snapshot = allocate(state, wheel::state_size(i.change()));
    if (!snapshot) return no_memory;
    wheel::save_state(i.change(), snapshot->bytes());
    return no_fault;
  });
}

fmi2Status fmi2SetFMUstate(fmi2Component c, fmi2FMUstate state) {
  const auto load = [](Instance& i, Snapshot& snapshot) {
    return wheel::load_state(i.change(), snapshot.bytes(), snapshot.size);
  };
  return guarded(c, legality::always, with_state(state, true, load));
}

fmi2Status fmi2FreeFMUstate(fmi2Component c, fmi2FMUstate* state) {
  return guarded(c, legality::always, [=](Instance&) {
    auto* const snapshot = state ? handle_of<Snapshot>(*state) : nullptr;
    if (!snapshot) return;
    fmi::release(snapshot);
    *state = nullptr;
  });
}

fmi2Status fmi2SerializedFMUstateSize(fmi2Component c, fmi2FMUstate state, size_t* size) {
  const auto measure = [=](Instance&, Snapshot& snapshot) {
    *size = snapshot.size;
    return no_fault;
  };
  return guarded(c, legality::always, with_state(state, size, measure));
}

fmi2Status fmi2SerializeFMUstate(fmi2Component c, fmi2FMUstate state, fmi2Byte bytes[], size_t size) {
  const auto copy = [=](Instance&, Snapshot& snapshot) {
    if (size < snapshot.size) return "the array is shorter than the state";
    std::memcpy(bytes, snapshot.bytes(), snapshot.size);
    return no_fault;
  };
  return guarded(c, legality::always, with_state(state, bytes, copy));
}

fmi2Status fmi2DeSerializeFMUstate(fmi2Component c, const fmi2Byte bytes[], size_t size, fmi2FMUstate* state) {
  return guarded(c, legality::always, [=](Instance& i) {
    if (!state || !bytes) return null_pointer;
    const char* fault = wheel::fault_of(i.wheel.demand.kind, reinterpret_cast<const unsigned char*>(bytes), size);
    Snapshot* snapshot = fault ? nullptr : allocate(state, size);
    if (!snapshot) return fault ? fault : no_memory;
    std::memcpy(snapshot->bytes(), bytes, size);
    return no_fault;
  });
}
