// FMI 2.0 functions: rollback. An FMU state is its own serialization: portable bytes that hold no pointers.
//
// A master may pass any pointer: only states that this library handed out are touched, and bytes from elsewhere become
// a state only after a scratch instance has taken them.
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <new>

#include "instance.hpp"
#include "registry.hpp"

using fmi::guarded, fmi::Instance, wheel::Topic;
namespace legality = fmi::legality;

namespace {

struct Snapshot {
  std::size_t size;  // of the bytes behind this header
  unsigned char* bytes() { return reinterpret_cast<unsigned char*>(this + 1); }
};

Snapshot* snapshot_of(fmi2FMUstate state) {
  return fmi::fmu_states.holds(state) ? static_cast<Snapshot*>(state) : nullptr;
}

// Frees a state; a pointer that was never handed out is left alone.
void free_state(fmi2FMUstate state) {
  if (fmi::fmu_states.remove(state)) std::free(state);
}

// A state of `size` bytes: the previous one where its size fits, else a new one, and the previous one is freed. Null
// without memory: then the previous one is kept.
Snapshot* allocate(fmi2FMUstate previous, std::size_t size) {
  Snapshot* const old = snapshot_of(previous);
  if (old && old->size == size) return old;
  void* const memory = std::malloc(sizeof(Snapshot) + size);
  if (!memory) return nullptr;
  if (!fmi::fmu_states.add(memory)) {
    std::free(memory);
    return nullptr;
  }
  free_state(previous);
  return ::new (memory) Snapshot{size};
}

constexpr const char *null_pointer = "the state, the size or the bytes are a null pointer",
                     *unknown_state = "this FMU did not create the state", *no_memory = "out of memory";

fmi2Status refuse(Instance& i, const char* why) { return i.log(Topic::error, "%s: %s.", i.called, why); }

}  // namespace

extern "C" {

fmi2Status fmi2GetFMUstate(fmi2Component c, fmi2FMUstate* state) {
  return guarded(c, legality::always, "fmi2GetFMUstate", [=](Instance& i) {
    if (!state) return refuse(i, null_pointer);
    Snapshot* snapshot = allocate(*state, i.simulation.state_size());
    if (!snapshot) return refuse(i, no_memory);
    i.simulation.save_state(snapshot->bytes());
    *state = snapshot;
    return fmi2OK;
  });
}

fmi2Status fmi2SetFMUstate(fmi2Component c, fmi2FMUstate state) {
  return guarded(c, legality::always, "fmi2SetFMUstate", [=](Instance& i) {
    Snapshot* snapshot = snapshot_of(state);
    if (!snapshot) return refuse(i, state ? unknown_state : null_pointer);
    const char* fault = i.simulation.load_state(snapshot->bytes(), snapshot->size, false);
    return fault ? refuse(i, fault) : fmi2OK;
  });
}

fmi2Status fmi2FreeFMUstate(fmi2Component c, fmi2FMUstate* state) {
  return guarded(c, legality::always, "fmi2FreeFMUstate", [=](Instance&) {
    if (!state || !snapshot_of(*state)) return;
    free_state(*state);
    *state = nullptr;
  });
}

fmi2Status fmi2SerializedFMUstateSize(fmi2Component c, fmi2FMUstate state, size_t* size) {
  return guarded(c, legality::always, "fmi2SerializedFMUstateSize", [=](Instance& i) {
    if (!state || !size) return refuse(i, null_pointer);
    const Snapshot* snapshot = snapshot_of(state);
    if (!snapshot) return refuse(i, unknown_state);
    *size = snapshot->size;
    return fmi2OK;
  });
}

fmi2Status fmi2SerializeFMUstate(fmi2Component c, fmi2FMUstate state, fmi2Byte bytes[], size_t size) {
  return guarded(c, legality::always, "fmi2SerializeFMUstate", [=](Instance& i) {
    if (!state || !bytes) return refuse(i, null_pointer);
    Snapshot* snapshot = snapshot_of(state);
    if (!snapshot) return refuse(i, unknown_state);
    if (size < snapshot->size) return refuse(i, "the array is shorter than the state");
    std::memcpy(bytes, snapshot->bytes(), snapshot->size);
    return fmi2OK;
  });
}

fmi2Status fmi2DeSerializeFMUstate(fmi2Component c, const fmi2Byte bytes[], size_t size, fmi2FMUstate* state) {
  return guarded(c, legality::always, "fmi2DeSerializeFMUstate", [=](Instance& i) {
    if (!state || !bytes) return refuse(i, null_pointer);
    Instance* scratch = Instance::create("scratch", nullptr, false, i.simulation.kind());
    if (!scratch) return refuse(i, no_memory);
    const char* fault = scratch->simulation.load_state(reinterpret_cast<const unsigned char*>(bytes), size, true);
    Instance::destroy(scratch);
    if (fault)
      return i.log(Topic::error, "%s: the bytes are damaged or not a state of this FMU and version (%s).", i.called,
                   fault);
    Snapshot* snapshot = allocate(*state, size);
    if (!snapshot) return refuse(i, no_memory);
    std::memcpy(snapshot->bytes(), bytes, size);
    *state = snapshot;
    return fmi2OK;
  });
}

}  // extern "C"
