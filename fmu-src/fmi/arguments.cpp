// Checks shared by all functions that read or set variables.
#include "arguments.hpp"

using wheel::Phase, wheel::Topic;

namespace fmi {

bool check_arrays(Instance& i, std::size_t count, const void* references, const void* values) {
  if (!count || (references && values)) return true;
  i.log(Topic::error, "%s: an array is a null pointer.", i.called);
  return false;
}

fmi2Status prepare_reading(Instance& i) {
  const Phase phase = i.simulation.phase();
  if (phase != Phase::initializing && phase != Phase::faulty) return fmi2OK;
  return i.simulation.prepare(phase == Phase::initializing) ? fmi2OK : fmi2Discard;
}

bool check_readable(Instance& i, fmi2ValueReference variable) {
  if (variable < wheel::stored_count || has_state(i.simulation.phase())) return true;
  i.log(Topic::error, "%s: \"%s\" has no value before a successful initialization.", i.called,
        wheel::row_of(variable).name);
  return false;
}

}  // namespace fmi
