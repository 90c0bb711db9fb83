// FMI 2.0 functions: derivatives of inputs and outputs in time, and of outputs by inputs and parameters.
#include <algorithm>
#include <cmath>

#include "arguments.hpp"
#include "digits.hpp"

using fmi::check_arrays, fmi::check_readable, fmi::Function, fmi::guarded, fmi::Instance, fmi::prepare_reading;
using support::Digits, wheel::Role, wheel::Topic;

namespace {

bool check_input(Instance& i, const char* name, fmi2ValueReference variable) {
  if (variable >= wheel::first_input && variable < wheel::stored_count) return true;
  i.log(Topic::error, "%s: value reference %u is not an input.", name, variable);
  return false;
}

// Of a directional derivative: a calculated real variable.
bool check_unknown(Instance& i, const char* name, fmi2ValueReference variable) {
  if (variable >= wheel::stored_count && wheel::is_variable(variable, wheel::Type::real)) return true;
  i.log(Topic::error, "%s: value reference %u is not a calculated real variable.", name, variable);
  return false;
}

bool check_output(Instance& i, const char* name, fmi2ValueReference variable) {
  if (variable < wheel::variable_count && wheel::row_of(variable).role == Role::output) return true;
  i.log(Topic::error, "%s: value reference %u is not an output.", name, variable);
  return false;
}

bool is_exchanged(const Instance& i) {
  return i.simulation.kind() == wheel::Kind::model_exchange && has_begun(i.simulation.phase());
}

// During the run outputs depend on inputs alone, in model exchange on the states too; in initialization mode they
// depend on the parameters.
bool check_known(Instance& i, const char* name, fmi2ValueReference variable) {
  if (is_exchanged(i) && wheel::state_of(variable) >= 0) return true;
  if (!has_begun(i.simulation.phase()) && variable < wheel::stored_count) return true;
  return check_input(i, name, variable);
}

struct Outputs {
  const fmi2ValueReference* references;
  std::size_t count;
  double* sums;
};

// The derivative of a function of a parameter from five values h apart, exact for polynomials of degree four: about the
// parameter, or to one side where a limit is near. h f' is the sum of weights[k] f(x + places[k] h).
struct Stencil {
  int places[5];
  double weights[5];
};
constexpr Stencil stencils[] = {{{-2, -1, 0, 1, 2}, {1.0 / 12, -8.0 / 12, 0, 8.0 / 12, -1.0 / 12}},
                                {{0, 1, 2, 3, 4}, {-25.0 / 12, 4, -3, 4.0 / 3, -1.0 / 4}},
                                {{0, -1, -2, -3, -4}, {25.0 / 12, -4, 3, -4.0 / 3, 1.0 / 4}}};

bool start_at(Instance& i, unsigned parameter, double value) {
  i.simulation.store(parameter, value);
  return i.simulation.prepare(false);
}

bool has_starts(Instance& i, unsigned parameter, double x, double h, const Stencil& stencil) {
  return std::all_of(stencil.places, stencil.places + 5,
                     [&](int place) { return start_at(i, parameter, x + place * h); });
}

// Differences from the value at x itself, so that an output that a parameter does not move has the derivative zero.
double quotient(Instance& i, unsigned output, unsigned parameter, double x, double h, const Stencil& stencil) {
  const auto value_at = [&](double near_x) {
    start_at(i, parameter, near_x);
    return i.simulation.value(output);
  };
  const double centre = value_at(x);
  double sum = 0;
  for (int k = 0; k < 5; ++k) sum += stencil.weights[k] * (value_at(x + stencil.places[k] * h) - centre);
  return sum / h;
}

// Adds seed * d output / d parameter in the initial state; an integer or boolean parameter adds nothing. Afterwards the
// instance has its own initial state again. False where no five allowed values lie near the parameter.
bool add_start_derivative(Instance& i, unsigned parameter, double seed, const Outputs& outputs) {
  const wheel::Row& row = wheel::row_of(parameter);
  if (row.type != wheel::Type::real) return true;
  const double x = i.simulation.value(parameter), size = std::fabs(x);
  // The step is relative to the parameter where it cannot be negative; for an angle, a place or a rate it is relative
  // to the parameter or to 1, whichever is larger.
  const double scale = row.min == 0 && x != 0 ? size : std::fmax(size, 1);
  bool found = false;
  for (const double share : {1e-3, 1e-6, 1e-9})
    for (const Stencil& stencil : stencils) {
      if (found || !has_starts(i, parameter, x, share * scale, stencil)) continue;
      for (std::size_t u = 0; u < outputs.count; ++u)
        outputs.sums[u] += seed * quotient(i, outputs.references[u], parameter, x, share * scale, stencil);
      found = true;
    }
  return start_at(i, parameter, x) && found;
}

bool add_derivative(Instance& i, const char* name, unsigned known, double seed, const Outputs& outputs) {
  if (is_exchanged(i)) {
    for (std::size_t u = 0; u < outputs.count; ++u)
      outputs.sums[u] += seed * i.simulation.partial(outputs.references[u], known);
    return true;
  }
  if (known >= wheel::first_input) {
    for (std::size_t u = 0; u < outputs.count; ++u)
      outputs.sums[u] += seed * i.simulation.sensitivity(outputs.references[u], known);
    return true;
  }
  if (add_start_derivative(i, known, seed, outputs)) return true;
  i.log(Topic::error, "%s: no allowed initial values lie close enough to %s = %s for a derivative.", name,
        wheel::row_of(known).name, Digits(i.simulation.value(known)).text);
  return false;
}

}  // namespace

extern "C" {

fmi2Status fmi2SetRealInputDerivatives(fmi2Component c, const fmi2ValueReference v[], size_t n,
                                       const fmi2Integer orders[], const fmi2Real values[]) {
  constexpr const char* name = "fmi2SetRealInputDerivatives";
  return guarded(c, Function::set_input_derivatives, name, [=](Instance& i) {
    if (!check_arrays(i, name, n, v, values) || !check_arrays(i, name, n, orders, values)) return fmi2Error;
    for (std::size_t k = 0; k < n; ++k) {
      if (!check_input(i, name, v[k])) return fmi2Error;
      if (orders[k] < 1 || orders[k] > wheel::max_order || !std::isfinite(values[k])) {
        i.log(Topic::error, "%s: derivative %d = %s of %s: orders 1 to %d and finite values are allowed.", name,
              orders[k], Digits(values[k]).text, wheel::row_of(v[k]).name, wheel::max_order);
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
      if (!check_known(i, name, knowns[k])) return fmi2Error;
    for (std::size_t k = 0; k < n_unknowns; ++k)
      if (!check_unknown(i, name, unknowns[k])) return fmi2Error;
    if (prepare_reading(i) != fmi2OK) return fmi2Discard;
    for (std::size_t u = 0; u < n_unknowns; ++u)
      if (!check_readable(i, name, unknowns[u])) return fmi2Error;
    const Outputs outputs = {unknowns, n_unknowns, values};
    std::fill_n(values, n_unknowns, 0.0);
    for (std::size_t k = 0; k < n_knowns; ++k)
      if (!add_derivative(i, name, knowns[k], seeds[k], outputs)) return fmi2Error;
    if (std::all_of(values, values + n_unknowns, [](double value) { return std::isfinite(value); })) return fmi2OK;
    i.log(Topic::discard, "%s: a derivative is not finite here.", name);
    return fmi2Discard;
  });
}

}  // extern "C"
