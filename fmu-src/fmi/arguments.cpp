// Checks shared by all functions that read or set variables.
#include "arguments.hpp"

using wheel::Topic;

namespace fmi {

bool check_arrays(Instance& i, const char* name, std::size_t count, const void* references, const void* values) {
  if (!count || (references && values)) return true;
  i.log(Topic::error, "%s: an array is a null pointer.", name);
  return false;
}

fmi2Status prepare_reading(Instance& i) {
  if (i.state != State::initialization || i.prepared) return fmi2OK;
  i.prepared = i.simulation.prepare(!i.faults_told);
  i.faults_told = true;
  return i.prepared ? fmi2OK : fmi2Discard;
}

bool check_readable(Instance& i, const char* name, fmi2ValueReference variable) {
  if (variable < wheel::stored_count || i.simulation.has_state()) return true;
  i.log(Topic::error, "%s: \"%s\" has no value before a successful initialization.", name,
        wheel::row_of(variable).name);
  return false;
}

}  // namespace fmi
