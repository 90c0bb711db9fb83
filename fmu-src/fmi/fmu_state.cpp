// FMI 2.0 functions: rollback. An FMU state is its own serialization: portable bytes that hold no pointers.
//
// A master may pass any pointer: only states that this library handed out are touched, and bytes from elsewhere become
// a state only after a scratch instance has taken them.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <new>

#include "bytes.hpp"
#include "instance.hpp"
#include "registry.hpp"

using fmi::Function, fmi::guarded, fmi::Instance, fmi::State, wheel::Topic;

namespace {

// The call state stands in front of the simulation's bytes, which have their own checksum.
struct CallState {
  unsigned char state, prepared, has_stop_time, last_step;
  unsigned char padding[4];
  double stop_time;
  std::uint64_t checksum;  // of the fields above
};

const unsigned char* bytes_of(const CallState& call) { return reinterpret_cast<const unsigned char*>(&call); }

constexpr std::size_t summed = offsetof(CallState, checksum);

struct Snapshot {
  std::size_t size;  // of the bytes behind this header
  unsigned char* bytes() { return reinterpret_cast<unsigned char*>(this + 1); }
};

Snapshot* snapshot_of(fmi2FMUstate state) {
  return fmi::fmu_states.holds(state) ? static_cast<Snapshot*>(state) : nullptr;
}

// Frees a state; a pointer that was never handed out is left alone.
void release(fmi2FMUstate state) {
  if (fmi::fmu_states.remove(state)) std::free(state);
}

// A state for `size` bytes in place of a previous one, which is used again if its size fits. Null without memory: then
// the previous one is kept.
Snapshot* allocate(fmi2FMUstate previous, std::size_t size) {
  Snapshot* const old = snapshot_of(previous);
  if (old && old->size == size) return old;
  void* const memory = std::malloc(sizeof(Snapshot) + size);
  if (!memory) return nullptr;
  if (!fmi::fmu_states.add(memory)) return std::free(memory), nullptr;
  release(previous);
  return ::new (memory) Snapshot{size};
}

void write(Instance& i, unsigned char* bytes) {
  CallState call = {};
  call.state = static_cast<unsigned char>(i.state);
  call.prepared = i.prepared;
  call.has_stop_time = i.has_stop_time;
  call.last_step = static_cast<unsigned char>(i.last_step);
  call.stop_time = i.stop_time;
  call.checksum = support::checksum_of(bytes_of(call), summed);
  std::memcpy(bytes, &call, sizeof call);
  i.simulation.save_state(bytes + sizeof call);
}

// False: the simulation cannot have been in this state; the instance stays as it was.
bool read(Instance& i, const unsigned char* bytes, std::size_t size) {
  CallState call;
  std::memcpy(&call, bytes, sizeof call);
  if (!i.simulation.load_state(bytes + sizeof call, size - sizeof call)) return false;
  i.state = static_cast<State>(call.state);
  i.prepared = call.prepared;
  i.has_stop_time = call.has_stop_time;
  i.last_step = static_cast<fmi2Status>(call.last_step);
  i.stop_time = call.stop_time;
  i.faults_told = false;
  return true;
}

// Each field by itself: one that `write` could have written.
bool is_sound(const CallState& call) {
  const unsigned char none[sizeof call.padding] = {};
  const bool stops = call.has_stop_time != 0;
  return support::has_checksum(bytes_of(call), summed, call.checksum) &&
         call.state <= static_cast<unsigned char>(State::error) && call.prepared <= 1 && call.has_stop_time <= 1 &&
         (call.last_step == fmi2OK || call.last_step == fmi2Discard || call.last_step == fmi2Error) &&
         !std::memcmp(call.padding, none, sizeof none) && (stops ? std::isfinite(call.stop_time) : call.stop_time == 0);
}

// Whether call state and simulation fit together.
bool agrees(const Instance& i) {
  const wheel::Simulation& simulation = i.simulation;
  switch (i.state) {
    case State::instantiated:
      return !simulation.has_state() && !simulation.started();
    case State::initialization:
      return !simulation.started() && (simulation.has_state() || !i.prepared);
    case State::step_complete:
      return simulation.started() && !simulation.ending() && i.last_step == fmi2OK;
    case State::step_failed:
      return simulation.started() && simulation.ending() && i.last_step == fmi2Discard;
    case State::terminated:
      return simulation.started();
    case State::error:
      break;
  }
  return simulation.has_state() || !simulation.started();
}

enum class Judged { sound, unsound, no_memory };

Judged judge(const unsigned char* bytes, std::size_t size) {
  CallState call;
  if (size < sizeof call) return Judged::unsound;
  std::memcpy(&call, bytes, sizeof call);
  if (!is_sound(call)) return Judged::unsound;
  Instance* scratch = Instance::create("scratch", nullptr, false);
  if (!scratch) return Judged::no_memory;
  const bool sound = read(*scratch, bytes, size) && agrees(*scratch);
  Instance::destroy(scratch);
  return sound ? Judged::sound : Judged::unsound;
}

constexpr const char *null_pointer = "the state, the size or the bytes are a null pointer",
                     *unknown_state = "the state is not one that this FMU handed out", *no_memory = "out of memory",
                     *damaged = "the bytes are damaged or not a state of this FMU and version";

fmi2Status refuse(Instance& i, const char* name, const char* why) {
  i.log(Topic::error, "%s: %s.", name, why);
  return fmi2Error;
}

}  // namespace

extern "C" {

fmi2Status fmi2GetFMUstate(fmi2Component c, fmi2FMUstate* state) {
  constexpr const char* name = "fmi2GetFMUstate";
  return guarded(c, Function::fmu_state, name, [=](Instance& i) {
    if (!state) return refuse(i, name, null_pointer);
    Snapshot* snapshot = allocate(*state, sizeof(CallState) + i.simulation.state_size());
    if (!snapshot) return refuse(i, name, no_memory);
    write(i, snapshot->bytes());
    *state = snapshot;
    return fmi2OK;
  });
}

fmi2Status fmi2SetFMUstate(fmi2Component c, fmi2FMUstate state) {
  constexpr const char* name = "fmi2SetFMUstate";
  return guarded(c, Function::set_fmu_state, name, [=](Instance& i) {
    Snapshot* snapshot = snapshot_of(state);
    if (!snapshot) return refuse(i, name, state ? unknown_state : null_pointer);
    // Bytes that this library handed out are sound, so only a lack of memory can make this fail.
    return read(i, snapshot->bytes(), snapshot->size) ? fmi2OK : refuse(i, name, no_memory);
  });
}

fmi2Status fmi2FreeFMUstate(fmi2Component c, fmi2FMUstate* state) {
  return guarded(c, Function::free_fmu_state, "fmi2FreeFMUstate", [=](Instance&) {
    if (!state || !snapshot_of(*state)) return fmi2OK;
    release(*state);
    *state = nullptr;
    return fmi2OK;
  });
}

fmi2Status fmi2SerializedFMUstateSize(fmi2Component c, fmi2FMUstate state, size_t* size) {
  constexpr const char* name = "fmi2SerializedFMUstateSize";
  return guarded(c, Function::fmu_state, name, [=](Instance& i) {
    if (!state || !size) return refuse(i, name, null_pointer);
    const Snapshot* snapshot = snapshot_of(state);
    if (!snapshot) return refuse(i, name, unknown_state);
    *size = snapshot->size;
    return fmi2OK;
  });
}

fmi2Status fmi2SerializeFMUstate(fmi2Component c, fmi2FMUstate state, fmi2Byte bytes[], size_t size) {
  constexpr const char* name = "fmi2SerializeFMUstate";
  return guarded(c, Function::fmu_state, name, [=](Instance& i) {
    if (!state || !bytes) return refuse(i, name, null_pointer);
    Snapshot* snapshot = snapshot_of(state);
    if (!snapshot) return refuse(i, name, unknown_state);
    if (size < snapshot->size) return refuse(i, name, "the array is shorter than the state");
    std::memcpy(bytes, snapshot->bytes(), snapshot->size);
    return fmi2OK;
  });
}

fmi2Status fmi2DeSerializeFMUstate(fmi2Component c, const fmi2Byte bytes[], size_t size, fmi2FMUstate* state) {
  constexpr const char* name = "fmi2DeSerializeFMUstate";
  return guarded(c, Function::fmu_state, name, [=](Instance& i) {
    if (!state || !bytes) return refuse(i, name, null_pointer);
    const Judged judged = judge(reinterpret_cast<const unsigned char*>(bytes), size);
    if (judged == Judged::unsound) return refuse(i, name, damaged);
    Snapshot* snapshot = judged == Judged::sound ? allocate(*state, size) : nullptr;
    if (!snapshot) return refuse(i, name, no_memory);
    std::memcpy(snapshot->bytes(), bytes, size);
    *state = snapshot;
    return fmi2OK;
  });
}

}  // extern "C"
