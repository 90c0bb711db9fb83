// FMI 2.0 functions: getting and setting variables.
#include <cmath>
#include <limits>

#include "arguments.hpp"
#include "digits.hpp"

using fmi::check_arrays, fmi::check_readable, fmi::guarded, fmi::Instance, fmi::prepare_reading;
using support::Digits, wheel::Role, wheel::Topic, wheel::Type;
namespace legality = fmi::legality;

namespace {

bool check_variable(Instance& i, fmi2ValueReference variable, Type type) {
  if (wheel::is_variable(variable, type)) return true;
  i.log(Topic::error, "%s: no variable of this type has the value reference %u.", i.called, variable);
  return false;
}

// A count that outgrows an Integer stays at the largest one. A choice that is no number, which only a forged state can
// bring, reads as the least.
template <class Value>
Value represented(double value) {
  using Limits = std::numeric_limits<Value>;
  if constexpr (Limits::is_integer)
    return static_cast<Value>(std::fmin(std::fmax(value, Limits::min()), Limits::max()));
  return static_cast<Value>(value);
}

template <class Value>
fmi2Status get(fmi2Component c, const char* name, Type type, const fmi2ValueReference variables[], std::size_t count,
               Value values[]) {
  return guarded(c, legality::get_values, name, [=](Instance& i) {
    if (!check_arrays(i, count, variables, values)) return fmi2Error;
    bool computed = false;
    for (std::size_t k = 0; k < count; ++k) {
      if (!check_variable(i, variables[k], type)) return fmi2Error;
      computed = computed || variables[k] >= wheel::stored_count;
    }
    if (computed && prepare_reading(i) != fmi2OK) return fmi2Discard;
    wheel::Reading* const now = computed && has_state(i.simulation.phase()) ? &i.simulation.reading() : nullptr;
    for (std::size_t k = 0; k < count; ++k) {
      const bool stored = variables[k] < wheel::stored_count;
      if (!stored && !check_readable(i, variables[k])) return fmi2Error;
      values[k] =
          represented<Value>(stored ? i.simulation.stored(variables[k]) : wheel::row_of(variables[k]).read(*now));
    }
    return fmi2OK;
  });
}

bool check_settable(Instance& i, fmi2ValueReference variable) {
  const wheel::Row& row = wheel::row_of(variable);
  const bool stored = variable < wheel::stored_count;
  if (!stored && i.simulation.kind() == wheel::Kind::model_exchange && is_running(i.simulation.phase()) &&
      wheel::state_index_of(variable) >= 0)
    return true;
  if (stored && (!is_running(i.simulation.phase()) || row.role != Role::parameter)) return true;
  i.log(Topic::error,
        stored ? "%s: \"%s\" cannot be set after initialization." : "%s: \"%s\" is calculated and cannot be set.",
        i.called, row.name);
  return false;
}

// During the run a value out of bounds is refused at once. Before the run it is taken, and all faults are logged
// together at the end of initialization.
bool check_value(Instance& i, fmi2ValueReference variable, double value) {
  const wheel::Row& row = wheel::row_of(variable);
  const bool bounded = variable < wheel::stored_count;
  const bool inside = std::isfinite(value) && (!bounded || (value >= row.min && value <= row.max));
  if (!is_running(i.simulation.phase()) || inside) return true;
  const bool low = value < row.min;
  const Digits given(value), limit(low ? row.min : row.max), kept(i.simulation.value(variable));
  if (std::isfinite(value))
    i.log(Topic::discard, "%s: %s = %s: it must be at %s %s; the value stays %s.", i.called, row.name, given.text,
          low ? "least" : "most", limit.text, kept.text);
  else
    i.log(Topic::discard, "%s: %s = %s: a finite number is needed; the value stays %s.", i.called, row.name, given.text,
          kept.text);
  return false;
}

template <class Value>
fmi2Status set(fmi2Component c, const char* name, Type type, const fmi2ValueReference variables[], std::size_t count,
               const Value values[]) {
  return guarded(c, legality::set_values, name, [=](Instance& i) {
    if (!check_arrays(i, count, variables, values)) return fmi2Error;
    for (std::size_t k = 0; k < count; ++k)
      if (!check_variable(i, variables[k], type) || !check_settable(i, variables[k])) return fmi2Error;
    for (std::size_t k = 0; k < count; ++k)
      if (!check_value(i, variables[k], static_cast<double>(values[k]))) return fmi2Discard;
    for (std::size_t k = 0; k < count; ++k) {
      const auto value = static_cast<double>(values[k]);
      if (variables[k] < wheel::stored_count)
        i.simulation.store(variables[k], value);
      else
        i.simulation.set_state(wheel::state_index_of(variables[k]), value);
    }
    return fmi2OK;
  });
}

// There are no string variables: only an empty request can be answered.
fmi2Status refuse_strings(fmi2Component c, const fmi::Rule& rule, const char* name,
                          const fmi2ValueReference variables[], std::size_t count, const void* values) {
  return guarded(c, rule, name, [=](Instance& i) {
    if (!count) return fmi2OK;
    if (!check_arrays(i, count, variables, values)) return fmi2Error;
    return i.log(Topic::error, "%s: no variable of this type has the value reference %u.", i.called, variables[0]);
  });
}

}  // namespace

extern "C" {

fmi2Status fmi2GetReal(fmi2Component c, const fmi2ValueReference v[], size_t n, fmi2Real values[]) {
  return get(c, "fmi2GetReal", Type::real, v, n, values);
}
fmi2Status fmi2GetInteger(fmi2Component c, const fmi2ValueReference v[], size_t n, fmi2Integer values[]) {
  return get(c, "fmi2GetInteger", Type::integer, v, n, values);
}
fmi2Status fmi2GetBoolean(fmi2Component c, const fmi2ValueReference v[], size_t n, fmi2Boolean values[]) {
  return get(c, "fmi2GetBoolean", Type::boolean, v, n, values);
}
fmi2Status fmi2SetReal(fmi2Component c, const fmi2ValueReference v[], size_t n, const fmi2Real values[]) {
  return set(c, "fmi2SetReal", Type::real, v, n, values);
}
fmi2Status fmi2SetInteger(fmi2Component c, const fmi2ValueReference v[], size_t n, const fmi2Integer values[]) {
  return set(c, "fmi2SetInteger", Type::integer, v, n, values);
}
fmi2Status fmi2SetBoolean(fmi2Component c, const fmi2ValueReference v[], size_t n, const fmi2Boolean values[]) {
  return set(c, "fmi2SetBoolean", Type::boolean, v, n, values);
}

fmi2Status fmi2GetString(fmi2Component c, const fmi2ValueReference v[], size_t n, fmi2String values[]) {
  return refuse_strings(c, legality::get_values, "fmi2GetString", v, n, values);
}
fmi2Status fmi2SetString(fmi2Component c, const fmi2ValueReference v[], size_t n, const fmi2String values[]) {
  return refuse_strings(c, legality::set_values, "fmi2SetString", v, n, values);
}

}  // extern "C"
