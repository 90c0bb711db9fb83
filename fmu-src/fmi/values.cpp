// FMI 2.0 functions: getting and setting variables, input and output derivatives, directional derivatives.
#include <cmath>

#include "instance.hpp"

using fmi::Function, fmi::guarded, fmi::Instance, fmi::State, wheel::Role, wheel::Topic, wheel::Type;

namespace {

// The start state behind outputs read in initialization mode; Discard while the parameters are faulty.
fmi2Status prepare_reading(Instance& i) {
  if (i.state != State::initialization || i.prepared) return fmi2OK;
  i.prepared = i.simulation.prepare(!i.faults_told);
  i.faults_told = true;
  return i.prepared ? fmi2OK : fmi2Discard;
}

bool check_arrays(Instance& i, const char* name, std::size_t count, const void* references, const void* values) {
  if (!count || (references && values)) return true;
  i.log(Topic::error, "%s: an array is a null pointer.", name);
  return false;
}

bool check_variable(Instance& i, const char* name, fmi2ValueReference variable, Type type) {
  if (wheel::is_variable(variable, type)) return true;
  i.log(Topic::error, "%s: no variable of this type has the value reference %u.", name, variable);
  return false;
}

// Calculated variables can be read once they exist: before a successful start only parameters and inputs do.
bool check_readable(Instance& i, const char* name, fmi2ValueReference variable) {
  if (variable < wheel::stored_count || i.simulation.exists()) return true;
  i.log(Topic::error, "%s: \"%s\" has no value before a successful initialization.", name,
        wheel::row_of(variable).name);
  return false;
}

template <class Value>
fmi2Status get(fmi2Component c, const char* name, Type type, const fmi2ValueReference variables[], std::size_t count,
               Value values[]) {
  return guarded(c, Function::get_values, name, [=](Instance& i) {
    if (!check_arrays(i, name, count, variables, values)) return fmi2Error;
    bool computed = false;
    for (std::size_t k = 0; k < count; ++k) {
      if (!check_variable(i, name, variables[k], type)) return fmi2Error;
      computed = computed || variables[k] >= wheel::stored_count;
    }
    if (computed && prepare_reading(i) != fmi2OK) return fmi2Discard;
    for (std::size_t k = 0; k < count; ++k) {
      if (!check_readable(i, name, variables[k])) return fmi2Error;
      values[k] = static_cast<Value>(i.simulation.value(variables[k]));
    }
    return fmi2OK;
  });
}

bool check_settable(Instance& i, const char* name, fmi2ValueReference variable) {
  const wheel::Row& row = wheel::row_of(variable);
  const bool stored = row.role != Role::output && row.role != Role::local;
  if (stored && (i.state != State::step_complete || row.role != Role::parameter)) return true;
  i.log(Topic::error, stored ? "%s: \"%s\" is fixed after initialization." : "%s: \"%s\" is calculated.", name,
        row.name);
  return false;
}

// While running a value out of bounds is refused at once; before, all faults are told together at the end of
// initialization.
bool check_value(Instance& i, const char* name, fmi2ValueReference variable, double value) {
  const wheel::Row& row = wheel::row_of(variable);
  if (i.state != State::step_complete || (std::isfinite(value) && value >= row.min && value <= row.max)) return true;
  i.log(Topic::discard, "%s: %s = %.9g is not allowed; the value stays %.9g.", name, row.name, value,
        i.simulation.stored(variable));
  return false;
}

template <class Value>
fmi2Status set(fmi2Component c, const char* name, Type type, const fmi2ValueReference variables[], std::size_t count,
               const Value values[]) {
  return guarded(c, Function::set_values, name, [=](Instance& i) {
    if (!check_arrays(i, name, count, variables, values)) return fmi2Error;
    for (std::size_t k = 0; k < count; ++k)
      if (!check_variable(i, name, variables[k], type) || !check_settable(i, name, variables[k])) return fmi2Error;
    for (std::size_t k = 0; k < count; ++k)
      if (!check_value(i, name, variables[k], static_cast<double>(values[k]))) return fmi2Discard;
    for (std::size_t k = 0; k < count; ++k) i.simulation.store(variables[k], static_cast<double>(values[k]));
    i.prepared = i.faults_told = false;
    return fmi2OK;
  });
}

// There are no string variables: an empty request is all that can be met.
fmi2Status refuse_strings(fmi2Component c, Function function, const char* name, const fmi2ValueReference variables[],
                          std::size_t count, const void* values) {
  return guarded(c, function, name, [=](Instance& i) {
    if (!count) return fmi2OK;
    if (check_arrays(i, name, count, variables, values))
      i.log(Topic::error, "%s: no variable of this type has the value reference %u.", name, variables[0]);
    return fmi2Error;
  });
}

bool check_input(Instance& i, const char* name, fmi2ValueReference variable) {
  if (variable >= wheel::first_input && variable < wheel::stored_count) return true;
  i.log(Topic::error, "%s: value reference %u is not an input.", name, variable);
  return false;
}

bool check_output(Instance& i, const char* name, fmi2ValueReference variable) {
  if (variable < wheel::variable_count() && wheel::row_of(variable).role == Role::output) return true;
  i.log(Topic::error, "%s: value reference %u is not an output.", name, variable);
  return false;
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
  return refuse_strings(c, Function::get_values, "fmi2GetString", v, n, values);
}
fmi2Status fmi2SetString(fmi2Component c, const fmi2ValueReference v[], size_t n, const fmi2String values[]) {
  return refuse_strings(c, Function::set_values, "fmi2SetString", v, n, values);
}

fmi2Status fmi2SetRealInputDerivatives(fmi2Component c, const fmi2ValueReference v[], size_t n,
                                       const fmi2Integer orders[], const fmi2Real values[]) {
  constexpr const char* name = "fmi2SetRealInputDerivatives";
  return guarded(c, Function::set_input_derivatives, name, [=](Instance& i) {
    if (!check_arrays(i, name, n, v, values) || !check_arrays(i, name, n, orders, values)) return fmi2Error;
    for (std::size_t k = 0; k < n; ++k) {
      if (!check_input(i, name, v[k])) return fmi2Error;
      if (orders[k] < 1 || orders[k] > wheel::Inputs::max_order || !std::isfinite(values[k])) {
        i.log(Topic::error, "%s: derivative %d = %g of %s: orders 1 to %d and finite values are allowed.", name,
              orders[k], values[k], wheel::row_of(v[k]).name, wheel::Inputs::max_order);
        return fmi2Error;
      }
    }
    for (std::size_t k = 0; k < n; ++k) i.simulation.set_input_derivative(v[k], orders[k], values[k]);
    return fmi2OK;
  });
}

fmi2Status fmi2GetRealOutputDerivatives(fmi2Component c, const fmi2ValueReference v[], size_t n,
                                        const fmi2Integer orders[], fmi2Real values[]) {
  constexpr const char* name = "fmi2GetRealOutputDerivatives";
  return guarded(c, Function::get_output_derivatives, name, [=](Instance& i) {
    if (!check_arrays(i, name, n, v, values) || !check_arrays(i, name, n, orders, values)) return fmi2Error;
    for (std::size_t k = 0; k < n; ++k) {
      if (!check_output(i, name, v[k]) || !check_readable(i, name, v[k])) return fmi2Error;
      if (orders[k] == 1) continue;
      i.log(Topic::error, "%s: order %d of %s: only the first derivative is provided.", name, orders[k],
            wheel::row_of(v[k]).name);
      return fmi2Error;
    }
    for (std::size_t k = 0; k < n; ++k) values[k] = i.simulation.rate(v[k]);
    return fmi2OK;
  });
}

fmi2Status fmi2GetDirectionalDerivative(fmi2Component c, const fmi2ValueReference unknowns[], size_t n_unknowns,
                                        const fmi2ValueReference knowns[], size_t n_knowns, const fmi2Real seeds[],
                                        fmi2Real values[]) {
  constexpr const char* name = "fmi2GetDirectionalDerivative";
  return guarded(c, Function::directional_derivative, name, [=](Instance& i) {
    if (!check_arrays(i, name, n_unknowns, unknowns, values) || !check_arrays(i, name, n_knowns, knowns, seeds))
      return fmi2Error;
    for (std::size_t k = 0; k < n_knowns; ++k)
      if (!check_input(i, name, knowns[k])) return fmi2Error;
    for (std::size_t k = 0; k < n_unknowns; ++k)
      if (!check_output(i, name, unknowns[k])) return fmi2Error;
    if (prepare_reading(i) != fmi2OK) return fmi2Discard;
    for (std::size_t u = 0; u < n_unknowns; ++u) {
      if (!check_readable(i, name, unknowns[u])) return fmi2Error;
      values[u] = 0;
      for (std::size_t k = 0; k < n_knowns; ++k)
        values[u] += seeds[k] * i.simulation.sensitivity(unknowns[u], knowns[k]);
    }
    return fmi2OK;
  });
}

}  // extern "C"
