// FMI 2.0 functions: derivatives of inputs and outputs in time, and of outputs by inputs and parameters.
#include <algorithm>
#include <cmath>

#include "exchange.hpp"
#include "instance.hpp"
#include "slopes.hpp"

using fmi::guarded, fmi::Instance, wheel::Role, wheel::Topic;
namespace legality = fmi::legality;

namespace {

constexpr const char* misfit = "%s: value reference %u is not %s.";

bool check_input(const Instance& i, fmi2ValueReference variable) {
  return i.check(variable >= wheel::first_input && variable < wheel::stored_count, misfit, variable, "an input");
}

bool check_output(const Instance& i, fmi2ValueReference variable) {
  const bool output = wheel::is_variable(variable, wheel::Type::real) && wheel::row_of(variable).role == Role::output;
  return i.check(output, misfit, variable, "a real output");
}

// Of a directional derivative.
bool check_unknown(const Instance& i, fmi2ValueReference variable) {
  const bool computed = variable >= wheel::stored_count && wheel::is_variable(variable, wheel::Type::real);
  return i.check(computed, misfit, variable, "a calculated real variable");
}

// During the run outputs depend on inputs alone, in model exchange on the states too; in initialization mode they
// depend on the parameters.
bool check_known(const Instance& i, fmi2ValueReference variable) {
  const bool exchanged = i.wheel.kind() == wheel::Kind::model_exchange, begun = has_begun(i.wheel.phase());
  if (begun ? exchanged && wheel::state_index_of(variable) >= 0 : variable < wheel::stored_count) return true;
  return check_input(i, variable);
}

}  // namespace

extern "C" {

fmi2Status fmi2SetRealInputDerivatives(fmi2Component c, const fmi2ValueReference v[], size_t n,
                                       const fmi2Integer orders[], const fmi2Real values[]) {
  return guarded(c, legality::set_input_derivatives, "fmi2SetRealInputDerivatives", [=](Instance& i) {
    if (!i.check_arrays(n, v, values) || !i.check_arrays(n, orders, values)) return fmi2Error;
    for (std::size_t k = 0; k < n; ++k) {
      if (!check_input(i, v[k])) return fmi2Error;
      if (orders[k] < 1 || orders[k] > wheel::max_order || !std::isfinite(values[k]))
        return i.log(Topic::error, "%s: derivative %d = %s of %s: orders 1 to %d and finite values are allowed.",
                     orders[k], values[k], wheel::row_of(v[k]).name, wheel::max_order);
    }
    for (std::size_t k = 0; k < n; ++k) wheel::set(i.wheel, v[k], values[k], orders[k]);
    return fmi2OK;
  });
}

fmi2Status fmi2GetRealOutputDerivatives(fmi2Component c, const fmi2ValueReference v[], size_t n,
                                        const fmi2Integer orders[], fmi2Real values[]) {
  return guarded(c, legality::get_output_derivatives, "fmi2GetRealOutputDerivatives", [=](Instance& i) {
    if (!i.check_arrays(n, v, values) || !i.check_arrays(n, orders, values)) return fmi2Error;
    for (std::size_t k = 0; k < n; ++k)
      if (!check_output(i, v[k]) ||
          !i.check(orders[k] == 1, "%s: order %d of %s: only the first derivative is provided.", orders[k],
                   wheel::row_of(v[k]).name))
        return fmi2Error;
    const fmi2Status status = i.prepare_reading(v, n);
    if (status == fmi2OK) wheel::read_rates(i.wheel, v, n, values);
    return status;
  });
}

fmi2Status fmi2GetDirectionalDerivative(fmi2Component c, const fmi2ValueReference unknowns[], size_t n_unknowns,
                                        const fmi2ValueReference knowns[], size_t n_knowns, const fmi2Real seeds[],
                                        fmi2Real values[]) {
  return guarded(c, legality::get_values, "fmi2GetDirectionalDerivative", [=](Instance& i) {
    if (!i.check_arrays(n_unknowns, unknowns, values) || !i.check_arrays(n_knowns, knowns, seeds)) return fmi2Error;
    for (std::size_t k = 0; k < n_knowns; ++k)
      if (!check_known(i, knowns[k])) return fmi2Error;
    for (std::size_t u = 0; u < n_unknowns; ++u)
      if (!check_unknown(i, unknowns[u])) return fmi2Error;
    std::fill_n(values, n_unknowns, 0.0);
    if (!n_unknowns || !n_knowns) return fmi2OK;
    if (const fmi2Status status = i.prepare_reading(unknowns, n_unknowns)) return status;
    for (std::size_t k = 0; k < n_knowns; ++k)
      if (!wheel::add_slopes(i.wheel, knowns[k], seeds[k], unknowns, n_unknowns, values))
        return i.log(Topic::error, "%s: no valid initial values near %s = %s for a derivative.",
                     wheel::row_of(knowns[k]).name, wheel::value_of(i.wheel, knowns[k]));
    if (std::all_of(values, values + n_unknowns, [](double value) { return std::isfinite(value); })) return fmi2OK;
    return i.log(Topic::discard, "%s: a derivative is not finite here.");
  });
}

}  // extern "C"
