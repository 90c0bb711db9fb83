// FMI 2.0 functions: rollback. An FMU state is its own serialization: portable bytes that hold no pointers.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>

#include "archive.hpp"
#include "instance.hpp"

using fmi::Function, fmi::guarded, fmi::Instance, fmi::State, wheel::Topic;

namespace {

// What the call state adds to the simulation's bytes, which have their own checksum.
struct CallState {
  unsigned char state, prepared, has_stop_time, last_step;
  unsigned char padding[4];
  double stop_time;
  std::uint64_t checksum;  // of the fields above
};

std::uint64_t checksum_of(const CallState& call) {
  return integrator::checksum_of(reinterpret_cast<const unsigned char*>(&call), offsetof(CallState, checksum));
}

struct Snapshot {
  // Null. fmi2FreeFMUstate frees what its argument points to; a caller that passes the state instead of its address
  // (fmusim 0.0.39) points to this word, and nothing is freed.
  void* nothing;
  std::size_t size;  // of the bytes behind this header
  unsigned char* bytes() { return reinterpret_cast<unsigned char*>(this + 1); }
};

Snapshot* allocate(Snapshot* previous, std::size_t size) {
  if (previous && previous->size == size) return previous;
  auto* snapshot = static_cast<Snapshot*>(std::realloc(previous, sizeof(Snapshot) + size));
  if (snapshot) *snapshot = {nullptr, size};
  return snapshot;
}

void write(Instance& i, unsigned char* bytes) {
  CallState call = {};
  call.state = static_cast<unsigned char>(i.state);
  call.prepared = i.prepared;
  call.has_stop_time = i.has_stop_time;
  call.last_step = static_cast<unsigned char>(i.last_step);
  call.stop_time = i.has_stop_time ? i.stop_time : 0;
  call.checksum = checksum_of(call);
  std::memcpy(bytes, &call, sizeof call);
  i.simulation.save_state(bytes + sizeof call);
}

fmi2Status read(Instance& i, const unsigned char* bytes) {
  CallState call;
  std::memcpy(&call, bytes, sizeof call);
  if (!i.simulation.load_state(bytes + sizeof call)) {
    i.log(Topic::error, "fmi2SetFMUstate: the solver does not take the state.");
    i.state = State::error;
    return fmi2Error;
  }
  i.state = static_cast<State>(call.state);
  i.prepared = call.prepared;
  i.has_stop_time = call.has_stop_time;
  i.last_step = static_cast<fmi2Status>(call.last_step);
  i.stop_time = call.stop_time;
  return fmi2OK;
}

bool is_sound(const unsigned char* bytes, std::size_t size) {
  CallState call;
  if (size < sizeof call) return false;
  std::memcpy(&call, bytes, sizeof call);
  return call.checksum == checksum_of(call) && call.state <= static_cast<unsigned char>(State::error) &&
         wheel::Simulation::is_state(bytes + sizeof(CallState), size - sizeof(CallState));
}

fmi2Status refuse(Instance& i, const char* name, const char* why) {
  i.log(Topic::error, "%s: %s.", name, why);
  return fmi2Error;
}

}  // namespace

extern "C" {

fmi2Status fmi2GetFMUstate(fmi2Component c, fmi2FMUstate* state) {
  return guarded(c, Function::fmu_state, "fmi2GetFMUstate", [=](Instance& i) {
    if (!state) return refuse(i, "fmi2GetFMUstate", "the state is a null pointer");
    const std::size_t size = sizeof(CallState) + i.simulation.state_size();
    Snapshot* snapshot = allocate(static_cast<Snapshot*>(*state), size);
    if (!snapshot) return refuse(i, "fmi2GetFMUstate", "memory is short");
    write(i, snapshot->bytes());
    *state = snapshot;
    return fmi2OK;
  });
}

fmi2Status fmi2SetFMUstate(fmi2Component c, fmi2FMUstate state) {
  return guarded(c, Function::set_fmu_state, "fmi2SetFMUstate", [=](Instance& i) {
    if (!state) return refuse(i, "fmi2SetFMUstate", "the state is a null pointer");
    return read(i, static_cast<Snapshot*>(state)->bytes());
  });
}

fmi2Status fmi2FreeFMUstate(fmi2Component c, fmi2FMUstate* state) {
  return guarded(c, Function::free_fmu_state, "fmi2FreeFMUstate", [=](Instance&) {
    if (state) {
      std::free(*state);
      *state = nullptr;
    }
    return fmi2OK;
  });
}

fmi2Status fmi2SerializedFMUstateSize(fmi2Component c, fmi2FMUstate state, size_t* size) {
  return guarded(c, Function::fmu_state, "fmi2SerializedFMUstateSize", [=](Instance& i) {
    if (!state || !size) return refuse(i, "fmi2SerializedFMUstateSize", "the state or the size is a null pointer");
    *size = static_cast<Snapshot*>(state)->size;
    return fmi2OK;
  });
}

fmi2Status fmi2SerializeFMUstate(fmi2Component c, fmi2FMUstate state, fmi2Byte bytes[], size_t size) {
  return guarded(c, Function::fmu_state, "fmi2SerializeFMUstate", [=](Instance& i) {
    if (!state || !bytes) return refuse(i, "fmi2SerializeFMUstate", "the state or the bytes are a null pointer");
    auto& snapshot = *static_cast<Snapshot*>(state);
    if (size < snapshot.size) return refuse(i, "fmi2SerializeFMUstate", "the array is shorter than the state");
    std::memcpy(bytes, snapshot.bytes(), snapshot.size);
    return fmi2OK;
  });
}

fmi2Status fmi2DeSerializeFMUstate(fmi2Component c, const fmi2Byte bytes[], size_t size, fmi2FMUstate* state) {
  return guarded(c, Function::fmu_state, "fmi2DeSerializeFMUstate", [=](Instance& i) {
    if (!state || !bytes) return refuse(i, "fmi2DeSerializeFMUstate", "the state or the bytes are a null pointer");
    if (!is_sound(reinterpret_cast<const unsigned char*>(bytes), size))
      return refuse(i, "fmi2DeSerializeFMUstate", "the bytes are damaged or not a state of this FMU and version");
    Snapshot* snapshot = allocate(static_cast<Snapshot*>(*state), size);
    if (!snapshot) return refuse(i, "fmi2DeSerializeFMUstate", "memory is short");
    std::memcpy(snapshot->bytes(), bytes, size);
    *state = snapshot;
    return fmi2OK;
  });
}

}  // extern "C"
