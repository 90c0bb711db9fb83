// Getting and setting variables, input and output derivatives, directional derivatives.
#include <cmath>

#include "session.hpp"

namespace fuzz {
namespace {

// Start values of the parameters and inputs, row by row as modelDescription.xml has them; inputs: a size that matters.
constexpr double usual[ref_first_output] = {20, 0.3, 0.05, 0.9, 0.9,   1.8, 9.81, 0.03, 1.57, 1.3, 1, 1, 0.1, -2,
                                            1,  1,   1,    1,   0.001, 1,   0,    30,   30,   30,  3, 3, 3};

}  // namespace

double Session::value_for(unsigned reference) {
  if (reference >= ref_first_output || in_.chance(2)) {
    // Absurd loads are bounded: CVODE would honestly follow them through millions of steps.
    const double value = in_.any();
    return reference >= ref_first_input && std::isfinite(value) ? std::remainder(value, 1e4) : value;
  }
  if (in_.chance(2)) return 0;
  const double value = usual[reference] * in_.factor();
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
  const fmi2Status status = checked(*now_, I | M | C, false, [&] {
    return fmi2SetReal(now_->component, null ? nullptr : references, count, values);
  });
  if (status != fmi2OK || now_->model.state != step_complete) return;
  for (unsigned k = 0; k < count; ++k)
    if (values[k] != 0) now_->model.free = false;
}

void Session::set_choices() {
  constexpr unsigned choices[] = {ref_formulation, ref_friction_law, ref_method};
  const unsigned variable = in_.chance(12) ? choices[in_.below(3)] : reference();
  const int whole = in_.chance(12) ? 1 + static_cast<int>(in_.below(3)) : static_cast<int>(in_.byte() * 0x01010101u);
  const unsigned flag = in_.chance(14) ? unsigned{ref_keep_contact} : reference();
  const int truth = in_.chance(14) ? static_cast<int>(in_.below(2)) : static_cast<int>(in_.byte());
  trace("  %u = %d, %u = %d\n", variable, whole, flag, truth);
  checked(*now_, I | M | C, false, [&] { return fmi2SetInteger(now_->component, &variable, 1, &whole); });
  checked(*now_, I | M | C, false, [&] { return fmi2SetBoolean(now_->component, &flag, 1, &truth); });
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
  checked(*now_, readable, false, [&] { return fmi2GetReal(c, null ? nullptr : references, count, reals); });
  checked(*now_, readable, false, [&] { return fmi2GetInteger(c, references, count, null ? nullptr : whole); });
  checked(*now_, readable, false, [&] { return fmi2GetBoolean(c, references, count, whole); });
}

void Session::strings() {
  const unsigned variable = reference(), count = in_.below(2);
  fmi2String text = "";
  const fmi2Component c = now_->component;
  checked(*now_, M | C | F | T | X, false, [&] { return fmi2GetString(c, &variable, count, &text); });
  checked(*now_, I | M | C, false, [&] { return fmi2SetString(c, &variable, count, &text); });
}

void Session::set_input_derivatives() {
  const unsigned input = in_.chance(14) ? ref_first_input + in_.below(6) : reference();
  const int order = in_.chance(14) ? 1 + static_cast<int>(in_.below(3)) : static_cast<int>(in_.byte()) - 128;
  const double value = value_for(input);
  trace("  derivative %d of %u = %.17g\n", order, input, value);
  const fmi2Status status = checked(
      *now_, I | M | C, false, [&] { return fmi2SetRealInputDerivatives(now_->component, &input, 1, &order, &value); });
  if (status == fmi2OK && value != 0) now_->model.free = false;
}

void Session::get_output_derivatives() {
  constexpr unsigned readable = C | F | T | X;
  const unsigned output = in_.chance(14) ? ref_first_output + in_.below(16) : reference();
  const int order = in_.chance(14) ? 1 : static_cast<int>(in_.byte()) - 128;
  double value = 0;
  const fmi2Status status = checked(*now_, readable, false, [&] {
    return fmi2GetRealOutputDerivatives(now_->component, &output, 1, &order, &value);
  });
  expect(status != fmi2OK || std::isfinite(value), "an output derivative is finite");
}

void Session::directional_derivative() {
  const unsigned unknown = in_.chance(14) ? ref_first_output + in_.below(16) : reference();
  const unsigned known = in_.chance(14) ? ref_first_input + in_.below(6) : reference();
  const double seed = 1;
  double value = 0;
  const fmi2Status status = checked(*now_, M | C | F | T | X, false, [&] {
    return fmi2GetDirectionalDerivative(now_->component, &unknown, 1, &known, 1, &seed, &value);
  });
  expect(status != fmi2OK || std::isfinite(value), "a directional derivative is finite");
}

}  // namespace fuzz
