// FMI 2.0 functions: derivatives of inputs and outputs in time, and of outputs by inputs and parameters.
#include <algorithm>
#include <cmath>

#include "exchange.hpp"
#include "instance.hpp"
#include "setting.hpp"
#include "slopes.hpp"

using fmi::guarded, fmi::Instance, wheel::Role, wheel::Topic;
namespace legality = fmi::legality;

namespace {

bool is_input(unsigned v) { return v >= wheel::first_input && v < wheel::stored_count; }

bool is_real_output(unsigned v) {
  return wheel::is_variable(v, wheel::Type::real) && wheel::row_of(v).role == Role::output;
}

// Of a directional derivative.
bool is_unknown(unsigned v) { return v >= wheel::stored_count && wheel::is_variable(v, wheel::Type::real); }

// During the run outputs depend on inputs alone, in model exchange on the states too; in initialization mode they
// depend on the parameters.
bool is_known(const Instance& i, unsigned v) {
  const bool exchanged = i.wheel.demand.kind == wheel::Kind::model_exchange,
             begun = has_left_initialization(i.wheel.run.phase);
  return is_input(v) || (begun ? exchanged && wheel::place_in_x(v) >= 0 : v < wheel::stored_count);
}

template <class Fits>
bool check_all(const Instance& i, const fmi2ValueReference v[], std::size_t n, Fits fits, const char* what) {
  return std::all_of(v, v + n, [&](fmi2ValueReference reference) {
    return i.check(fits(wheel::variable_of(reference)), "%s: value reference %u is not %s.", reference, what);
  });
}

}  // namespace

fmi2Status fmi2SetRealInputDerivatives(fmi2Component c, const fmi2ValueReference v[], size_t n,
                                       const fmi2Integer orders[], const fmi2Real values[]) {
  return guarded(c, legality::set_input_derivatives, [=](Instance& i) {
    if (!i.check_arrays(n, v, values) || !i.check_arrays(n, orders, values)) return fmi2Error;
    if (!check_all(i, v, n, is_input, "an input")) return fmi2Error;
    const wheel::Listed inputs = {v};
    for (std::size_t k = 0; k < n; ++k) {
      const char* const name = wheel::row_of(inputs[k]).name;
      if (!i.check(orders[k] >= 1 && orders[k] <= wheel::max_order && std::isfinite(values[k]),
                   "%s: derivative %d = %s of %s: orders 1 to %d and finite values are allowed.", orders[k], values[k],
                   name, wheel::max_order) ||
          !i.check(values[k] == 0 || !is_idle(i.wheel, inputs[k]),
                   "%s: derivative %d = %s of %s: this input needs guided = true and co-simulation.", orders[k],
                   values[k], name))
        return fmi2Error;
    }
    for (std::size_t k = 0; k < n; ++k) wheel::set(i.change(), inputs[k], values[k], orders[k]);
    return fmi2OK;
  });
}

fmi2Status fmi2GetRealOutputDerivatives(fmi2Component c, const fmi2ValueReference v[], size_t n,
                                        const fmi2Integer orders[], fmi2Real values[]) {
  return guarded(c, legality::get_output_derivatives, [=](Instance& i) {
    if (!i.check_arrays(n, v, values) || !i.check_arrays(n, orders, values)) return fmi2Error;
    if (!check_all(i, v, n, is_real_output, "a real output")) return fmi2Error;
    for (std::size_t k = 0; k < n; ++k)
      if (!i.check(orders[k] == 1, "%s: order %d of %s: only the first derivative is provided.", orders[k],
                   wheel::row_of(wheel::variable_of(v[k])).name))
        return fmi2Error;
    const fmi2Status status = i.prepare_reading(v, n);
    if (status == fmi2OK) wheel::read_rates(i.wheel, {v}, n, values);
    return status;
  });
}

fmi2Status fmi2GetDirectionalDerivative(fmi2Component c, const fmi2ValueReference unknowns[], size_t n_unknowns,
                                        const fmi2ValueReference knowns[], size_t n_knowns, const fmi2Real seeds[],
                                        fmi2Real values[]) {
  return guarded(c, legality::get_values, [=](Instance& i) {
    if (!i.check_arrays(n_unknowns, unknowns, values) || !i.check_arrays(n_knowns, knowns, seeds)) return fmi2Error;
    const auto known = [&](unsigned v) { return is_known(i, v); };
    if (!check_all(i, knowns, n_knowns, known, "an input")) return fmi2Error;
    if (!check_all(i, unknowns, n_unknowns, is_unknown, "a calculated real variable")) return fmi2Error;
    std::fill_n(values, n_unknowns, 0.0);
    if (!n_unknowns || !n_knowns) return fmi2OK;
    if (const fmi2Status status = i.prepare_reading(unknowns, n_unknowns)) return status;
    for (std::size_t k = 0; k < n_knowns; ++k) {
      const unsigned variable = wheel::variable_of(knowns[k]);
      if (!wheel::add_slopes(i.wheel, variable, seeds[k], {unknowns}, n_unknowns, values))
        return i.log(Topic::error, "%s: no valid initial values near %s = %s for a derivative.",
                     wheel::row_of(variable).name, i.value_of(variable));
    }
    if (std::all_of(values, values + n_unknowns, [](double value) { return std::isfinite(value); })) return fmi2OK;
    return i.log(Topic::discard, "%s: a derivative is not finite here.");
  });
}
