// FMI 2.0 functions: getting and setting variables.
#include <algorithm>
#include <cmath>
#include <limits>

#include "exchange.hpp"
#include "instance.hpp"
#include "setting.hpp"

using fmi::guarded, fmi::Instance, wheel::Role, wheel::Topic, wheel::Type;
namespace legality = fmi::legality;

namespace {

bool check_variables(const Instance& i, Type type, const fmi2ValueReference variables[], std::size_t count,
                     const void* values) {
  return i.check_arrays(count, variables, values) && std::all_of(variables, variables + count, [&](unsigned reference) {
           return i.check(wheel::is_variable(wheel::variable_of(reference), type),
                          "%s: no variable of this type has the value reference %u.", reference);
         });
}

// (number) => value of the type that the call reads. A count that outgrows an Integer stays at the largest one. A
// choice that is no number, which only a forged state can bring, reads as the least.
template <class Value>
Value represented(double value) {
  using Limits = std::numeric_limits<Value>;
  if constexpr (Limits::is_integer)
    return static_cast<Value>(std::fmin(std::fmax(value, Limits::min()), Limits::max()));
  return static_cast<Value>(value);
}

template <class Value>
auto get(Type type, const fmi2ValueReference variables[], std::size_t count, Value values[]) {
  return [=](Instance& i) {
    if (!check_variables(i, type, variables, count, values)) return fmi2Error;
    const fmi2Status status = i.prepare_reading(variables, count);
    for (std::size_t k = 0; k < count && status == fmi2OK; ++k)
      values[k] = represented<Value>(i.value_of(wheel::variable_of(variables[k])));
    return status;
  };
}

// Parameters before the run, inputs and the road at any time, the states while another solver moves them.
bool check_settable(const Instance& i, unsigned variable) {
  const wheel::Row& row = wheel::row_of(variable);
  const bool running = is_running(i.wheel.run.phase);
  if (variable < wheel::stored_count)
    return i.check(!running || row.role != Role::parameter, "%s: \"%s\" cannot be set after initialization.", row.name);
  return i.check(running && i.wheel.demand.kind == wheel::Kind::model_exchange && wheel::place_in_x(variable) >= 0,
                 "%s: \"%s\" is calculated and cannot be set.", row.name);
}

// During the run a value out of bounds is refused at once. Before the run it is taken, and all faults are logged
// together at the end of initialization.
bool check_value(Instance& i, unsigned variable, double value) {
  if (!is_running(i.wheel.run.phase)) return true;
  const auto refuse = [&](const char* reason, auto... limit) {
    const double kept = i.value_of(variable);
    i.log(Topic::discard, reason, wheel::row_of(variable).name, value, limit..., kept);
    return false;
  };
  const wheel::Limit passed = wheel::broken_limit(variable, value);
  if (!std::isfinite(value)) return refuse("%s: %s = %s: a finite number is needed; the value stays %s.");
  if (passed.relation)
    return refuse("%s: %s = %s: it must be %s %s; the value stays %s.", passed.relation, passed.value);
  if (value != 0 && is_idle(i.wheel, variable))
    return refuse("%s: %s = %s: this input needs guided = true and co-simulation; the value stays %s.");
  if (variable == wheel::variable::mu_slide && value > 0 && !i.wheel.setup.can_slide())
    return refuse("%s: %s = %s: whether the wheel can slide is decided at the start; the value stays %s.");
  return true;
}

// (value set) => value taken: masters form difference quotients about a brake that is off, and set a little less.
double taken(Instance& i, unsigned variable, double value) {
  constexpr double little = 1e-6;  // N m, or of the capacity
  if (variable != wheel::variable::M_brake || !(value < 0)) return value;
  return value >= -little * std::fmax(1, i.value_of(variable)) ? 0 : value;
}

template <class Value>
auto set(Type type, const fmi2ValueReference variables[], std::size_t count, const Value values[]) {
  return [=](Instance& i) {
    if (!check_variables(i, type, variables, count, values)) return fmi2Error;
    const wheel::Listed listed = {variables};
    for (std::size_t k = 0; k < count; ++k)
      if (!check_settable(i, listed[k])) return fmi2Error;
    const auto value = [&](std::size_t k) { return taken(i, listed[k], static_cast<double>(values[k])); };
    for (std::size_t k = 0; k < count; ++k)
      if (!check_value(i, listed[k], value(k))) return fmi2Discard;
    for (std::size_t k = 0; k < count; ++k) wheel::set(i.change(), listed[k], value(k));
    return fmi2OK;
  };
}

// Only an empty request can be answered.
auto check_strings(const fmi2ValueReference variables[], std::size_t count, const void* values) {
  return [=](Instance& i) { return check_variables(i, Type::string, variables, count, values) ? fmi2OK : fmi2Error; };
}

}  // namespace

fmi2Status fmi2GetReal(fmi2Component c, const fmi2ValueReference v[], size_t n, fmi2Real values[]) {
  return guarded(c, legality::get_values, get(Type::real, v, n, values));
}
fmi2Status fmi2GetInteger(fmi2Component c, const fmi2ValueReference v[], size_t n, fmi2Integer values[]) {
  return guarded(c, legality::get_values, get(Type::integer, v, n, values));
}
fmi2Status fmi2GetBoolean(fmi2Component c, const fmi2ValueReference v[], size_t n, fmi2Boolean values[]) {
  return guarded(c, legality::get_values, get(Type::boolean, v, n, values));
}
fmi2Status fmi2SetReal(fmi2Component c, const fmi2ValueReference v[], size_t n, const fmi2Real values[]) {
  return guarded(c, legality::set_values, set(Type::real, v, n, values));
}
fmi2Status fmi2SetInteger(fmi2Component c, const fmi2ValueReference v[], size_t n, const fmi2Integer values[]) {
  return guarded(c, legality::set_values, set(Type::integer, v, n, values));
}
fmi2Status fmi2SetBoolean(fmi2Component c, const fmi2ValueReference v[], size_t n, const fmi2Boolean values[]) {
  return guarded(c, legality::set_values, set(Type::boolean, v, n, values));
}

fmi2Status fmi2GetString(fmi2Component c, const fmi2ValueReference v[], size_t n, fmi2String values[]) {
  return guarded(c, legality::get_values, check_strings(v, n, values));
}
fmi2Status fmi2SetString(fmi2Component c, const fmi2ValueReference v[], size_t n, const fmi2String values[]) {
  return guarded(c, legality::set_values, check_strings(v, n, values));
}
