// FMI 2.0 functions: derivatives of inputs and outputs in time, and of outputs by inputs and parameters.
#include <algorithm>
#include <cmath>

#include "arguments.hpp"
#include "digits.hpp"

using fmi::check_arrays, fmi::check_readable, fmi::guarded, fmi::Instance, fmi::prepare_reading;
using support::Digits, wheel::Role, wheel::Topic;
namespace legality = fmi::legality;

namespace {

bool check(Instance& i, fmi2ValueReference variable, bool fits, const char* what) {
  if (!fits) i.log(Topic::error, "%s: value reference %u is not %s.", i.called, variable, what);
  return fits;
}

bool check_input(Instance& i, fmi2ValueReference variable) {
  return check(i, variable, variable >= wheel::first_input && variable < wheel::stored_count, "an input");
}

// Of a directional derivative.
bool check_unknown(Instance& i, fmi2ValueReference variable) {
  const bool computed = variable >= wheel::stored_count && wheel::is_variable(variable, wheel::Type::real);
  return check(i, variable, computed, "a calculated real variable");
}

bool check_output(Instance& i, fmi2ValueReference variable) {
  const bool output = variable < wheel::variable_count && wheel::row_of(variable).role == Role::output;
  return check(i, variable, output, "an output");
}

// During the run outputs depend on inputs alone, in model exchange on the states too; in initialization mode they
// depend on the parameters.
bool check_known(Instance& i, fmi2ValueReference variable) {
  const bool exchanged = i.simulation.kind() == wheel::Kind::model_exchange, begun = has_begun(i.simulation.phase());
  if (begun ? exchanged && wheel::state_index_of(variable) >= 0 : variable < wheel::stored_count) return true;
  return check_input(i, variable);
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

bool add_derivative(Instance& i, unsigned known, double seed, const Outputs& outputs) {
  if (known >= wheel::first_input) {
    for (std::size_t u = 0; u < outputs.count; ++u)
      outputs.sums[u] += seed * i.simulation.sensitivity(outputs.references[u], known);
    return true;
  }
  if (add_start_derivative(i, known, seed, outputs)) return true;
  i.log(Topic::error, "%s: no valid initial values near %s = %s for a derivative.", i.called, wheel::row_of(known).name,
        Digits(i.simulation.value(known)).text);
  return false;
}

}  // namespace

extern "C" {

fmi2Status fmi2SetRealInputDerivatives(fmi2Component c, const fmi2ValueReference v[], size_t n,
                                       const fmi2Integer orders[], const fmi2Real values[]) {
  return guarded(c, legality::set_input_derivatives, "fmi2SetRealInputDerivatives", [=](Instance& i) {
    if (!check_arrays(i, n, v, values) || !check_arrays(i, n, orders, values)) return fmi2Error;
    for (std::size_t k = 0; k < n; ++k) {
      if (!check_input(i, v[k])) return fmi2Error;
      if (orders[k] < 1 || orders[k] > wheel::max_order || !std::isfinite(values[k]))
        return i.log(Topic::error, "%s: derivative %d = %s of %s: orders 1 to %d and finite values are allowed.",
                     i.called, orders[k], Digits(values[k]).text, wheel::row_of(v[k]).name, wheel::max_order);
    }
    for (std::size_t k = 0; k < n; ++k) i.simulation.set_input_derivative(v[k], orders[k], values[k]);
    return fmi2OK;
  });
}

fmi2Status fmi2GetRealOutputDerivatives(fmi2Component c, const fmi2ValueReference v[], size_t n,
                                        const fmi2Integer orders[], fmi2Real values[]) {
  return guarded(c, legality::get_output_derivatives, "fmi2GetRealOutputDerivatives", [=](Instance& i) {
    if (!check_arrays(i, n, v, values) || !check_arrays(i, n, orders, values)) return fmi2Error;
    for (std::size_t k = 0; k < n; ++k) {
      if (!check_output(i, v[k]) || !check_readable(i, v[k])) return fmi2Error;
      if (orders[k] != 1)
        return i.log(Topic::error, "%s: order %d of %s: only the first derivative is provided.", i.called, orders[k],
                     wheel::row_of(v[k]).name);
    }
    for (std::size_t k = 0; k < n; ++k) values[k] = wheel::row_of(v[k]).read_rate(i.simulation.reading());
    return fmi2OK;
  });
}

fmi2Status fmi2GetDirectionalDerivative(fmi2Component c, const fmi2ValueReference unknowns[], size_t n_unknowns,
                                        const fmi2ValueReference knowns[], size_t n_knowns, const fmi2Real seeds[],
                                        fmi2Real values[]) {
  return guarded(c, legality::get_values, "fmi2GetDirectionalDerivative", [=](Instance& i) {
    if (!check_arrays(i, n_unknowns, unknowns, values) || !check_arrays(i, n_knowns, knowns, seeds)) return fmi2Error;
    for (std::size_t k = 0; k < n_knowns; ++k)
      if (!check_known(i, knowns[k])) return fmi2Error;
    for (std::size_t k = 0; k < n_unknowns; ++k)
      if (!check_unknown(i, unknowns[k])) return fmi2Error;
    if (prepare_reading(i) != fmi2OK) return fmi2Discard;
    for (std::size_t u = 0; u < n_unknowns; ++u)
      if (!check_readable(i, unknowns[u])) return fmi2Error;
    const Outputs outputs = {unknowns, n_unknowns, values};
    std::fill_n(values, n_unknowns, 0.0);
    for (std::size_t k = 0; k < n_knowns; ++k)
      if (!add_derivative(i, knowns[k], seeds[k], outputs)) return fmi2Error;
    if (std::all_of(values, values + n_unknowns, [](double value) { return std::isfinite(value); })) return fmi2OK;
    return i.log(Topic::discard, "%s: a derivative is not finite here.", i.called);
  });
}

}  // extern "C"
