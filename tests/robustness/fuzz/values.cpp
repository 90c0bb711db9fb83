// Getting and setting variables, input and output derivatives, directional derivatives.
#include <cmath>

#include "session.hpp"

namespace fuzz {
namespace {

// Sizes that matter: the start values of the parameters as modelDescription.xml has them, and what moves a wheel.
double usual_size(unsigned reference) {
  const Row& row = row_of(reference);
  return row.role == Role::input ? 10 : row.start == 0 ? 0.1 : row.start;
}

}  // namespace

double Session::value_for(unsigned reference) {
  if (reference >= ref_first_output || in_.chance(2)) {
    // Extreme loads are limited: CVODE would honestly follow them through the million steps that a call may take.
    const double value = in_.any();
    return reference >= ref_first_input && std::isfinite(value) ? std::remainder(value, 1e4) : value;
  }
  if (in_.chance(2)) return 0;
  const double value = usual_size(reference) * in_.factor();
  return in_.chance(4) ? -value : value;
}

unsigned Session::reference() {
  const unsigned choice = in_.byte();
  return choice < 250 ? choice % ref_count : choice * 0x01010101u;
}

void Session::set_reals() {
  constexpr unsigned most = 4;
  const unsigned count = in_.below(most + 1);
  unsigned references[most];
  double values[most];
  for (unsigned k = 0; k < count; ++k) {
    references[k] = reference();
    values[k] = value_for(references[k]);
    trace("  %u = %.17g\n", references[k], values[k]);
  }
  const bool null = in_.chance(1);
  const fmi2Status status = checked(
      *now_, I | M | C, [&] { return fmi2SetReal(now_->component, null ? nullptr : references, count, values); });
  if (status != fmi2OK || now_->model.state != step_complete) return;
  for (unsigned k = 0; k < count; ++k)
    if (may_do_work(references[k]) && values[k] != 0) now_->model.free = false;
}

void Session::set_choices() {
  constexpr unsigned choices[] = {ref_formulation, ref_friction_law, ref_method};
  const unsigned variable = in_.chance(12) ? choices[in_.below(3)] : reference();
  const int whole = in_.chance(12) ? 1 + static_cast<int>(in_.below(4)) : static_cast<int>(in_.byte() * 0x01010101u);
  const unsigned flag = in_.chance(14) ? unsigned{ref_keep_contact} : reference();
  const int truth = in_.chance(14) ? static_cast<int>(in_.below(2)) : static_cast<int>(in_.byte());
  trace("  %u = %d, %u = %d\n", variable, whole, flag, truth);
  checked(*now_, I | M | C, [&] { return fmi2SetInteger(now_->component, &variable, 1, &whole); });
  checked(*now_, I | M | C, [&] { return fmi2SetBoolean(now_->component, &flag, 1, &truth); });
}

void Session::get_values() {
  constexpr unsigned readable = M | C | F | T | X, most = 5;
  const unsigned count = in_.below(most + 1);
  unsigned references[most];
  for (unsigned k = 0; k < count; ++k) references[k] = reference();
  const bool null = in_.chance(1);
  double reals[most];
  int whole[most];
  const fmi2Component c = now_->component;
  checked(*now_, readable, [&] { return fmi2GetReal(c, null ? nullptr : references, count, reals); });
  checked(*now_, readable, [&] { return fmi2GetInteger(c, references, count, null ? nullptr : whole); });
  checked(*now_, readable, [&] { return fmi2GetBoolean(c, references, count, whole); });
}

void Session::strings() {
  const unsigned variable = reference(), count = in_.below(2);
  fmi2String text = "";
  const fmi2Component c = now_->component;
  checked(*now_, M | C | F | T | X, [&] { return fmi2GetString(c, &variable, count, &text); });
  checked(*now_, I | M | C, [&] { return fmi2SetString(c, &variable, count, &text); });
}

// Usually one, sometimes several or none; an array may be missing.
void Session::set_input_derivatives() {
  constexpr unsigned most = 4;
  const unsigned count = in_.chance(12) ? 1 : in_.below(most + 1), null = in_.chance(1) ? in_.below(3) : 3;
  unsigned inputs[most];
  int orders[most];
  double values[most];
  for (unsigned k = 0; k < count; ++k) {
    inputs[k] = in_.chance(14) ? ref_first_input + in_.below(input_count) : reference();
    orders[k] = in_.chance(14) ? 1 + static_cast<int>(in_.below(3)) : static_cast<int>(in_.byte()) - 128;
    values[k] = value_for(inputs[k]);
    trace("  derivative %d of %u = %.17g\n", orders[k], inputs[k], values[k]);
  }
  const fmi2Status status = checked(*now_, I | M | C, [&] {
    return fmi2SetRealInputDerivatives(now_->component, null == 0 ? nullptr : inputs, count,
                                       null == 1 ? nullptr : orders, null == 2 ? nullptr : values);
  });
  if (status == fmi2OK && count > 0) now_->model.free = false;
}

void Session::get_output_derivatives() {
  constexpr unsigned readable = C | F | T | X, most = 4;
  const unsigned count = in_.chance(8) ? 1 : in_.below(most + 1);
  const bool null = in_.chance(1);
  unsigned outputs[most];
  int orders[most];
  double values[most] = {};
  for (unsigned k = 0; k < count; ++k) {
    outputs[k] = in_.chance(14) ? ref_first_output + in_.below(output_count) : reference();
    orders[k] = in_.chance(14) ? 1 : static_cast<int>(in_.byte()) - 128;
  }
  const fmi2Status status = checked(*now_, readable, [&] {
    return fmi2GetRealOutputDerivatives(now_->component, outputs, count, orders, null ? nullptr : values);
  });
  for (const double value : values) expect(status != fmi2OK || std::isfinite(value), "an output derivative is finite");
}

void Session::directional_derivative() {
  constexpr unsigned most = 3;
  const unsigned rows = in_.chance(8) ? 1 : in_.below(most + 1), columns = in_.chance(8) ? 1 : in_.below(most + 1);
  const bool null = in_.chance(1);
  unsigned unknowns[most], knowns[most];
  for (unsigned k = 0; k < rows; ++k)
    unknowns[k] = in_.chance(14) ? ref_first_output + in_.below(output_count) : reference();
  for (unsigned k = 0; k < columns; ++k)
    knowns[k] = in_.chance(14) ? ref_first_input + in_.below(input_count) : reference();
  const double seeds[most] = {1, -2, 0.5};
  double values[most] = {};
  const fmi2Status status = checked(*now_, M | C | F | T | X, [&] {
    return fmi2GetDirectionalDerivative(now_->component, unknowns, rows, knowns, columns, null ? nullptr : seeds,
                                        values);
  });
  for (const double value : values) expect(status != fmi2OK || std::isfinite(value), "a derivative is finite");
}

}  // namespace fuzz
