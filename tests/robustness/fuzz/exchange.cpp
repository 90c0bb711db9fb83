// Model exchange: one more instance, moved by hand through any states, inputs and events, with what must hold.
#include <algorithm>
#include <cmath>

#include "session.hpp"

namespace fuzz {
namespace {

constexpr int states = 8, indicators = WHEEL_INDICATORS;

bool all_finite(const double* values, int count) {
  return std::all_of(values, values + count, [](double value) { return std::isfinite(value); });
}

void save_and_restore(fmi2Component c) {
  fmi2FMUstate state = nullptr;
  const Digest before = digest(c);
  expect(fmi2GetFMUstate(c, &state) == fmi2OK, "a state can be taken");
  expect(fmi2SetFMUstate(c, state) == fmi2OK, "a state that was handed out is restored");
  expect(digest(c) == before, "a restored state has the same bytes");
  expect(fmi2FreeFMUstate(c, &state) == fmi2OK, "a state can be freed");
}

void set_input(fmi2Component c, Bytes& in) {
  const unsigned input = any_of(Role::input, in.byte()), s = ref_s;
  const double value = in.any(), friction = in.chance(8) ? 0.02 : 0;
  fmi2SetReal(c, &input, 1, &value);
  if (in.chance(4)) expect(fmi2SetReal(c, &s, 1, &friction) == fmi2OK, "s is tunable");
}

}  // namespace

bool decide(fmi2Component c) {
  fmi2EventInfo info = {};
  expect(fmi2NewDiscreteStates(c, &info) == fmi2OK, "event mode decides");
  expect(!info.newDiscreteStatesNeeded, "one pass is enough");
  return !info.terminateSimulation;
}

bool move_freely(fmi2Component c, double h, Bytes& in) {
  double x[states], rates[states], back[states], z[indicators];
  fmi2Boolean wanted = fmi2False, ends = fmi2False;
  expect(fmi2GetContinuousStates(c, x, states) == fmi2OK, "states can be read");
  const fmi2Status status = fmi2GetDerivatives(c, rates, states);
  expect(status == fmi2OK || status == fmi2Discard, "derivatives are given or discarded");
  expect(status != fmi2OK || all_finite(rates, states), "a derivative is finite");
  for (int i = 0; i < states; ++i) {
    if (status == fmi2OK) x[i] += h * rates[i];
    if (in.chance(1)) x[i] = in.any();
  }
  const bool taken = fmi2SetContinuousStates(c, x, states) == fmi2OK;
  expect(taken || !all_finite(x, states), "finite states are taken");
  expect(fmi2GetContinuousStates(c, back, states) == fmi2OK, "states can be read");
  expect(!taken || std::equal(back, back + states, x), "states are read back to the bit");
  const bool given = fmi2GetEventIndicators(c, z, indicators) == fmi2OK;
  expect(given == all_finite(z, indicators), "indicators are finite");
  expect(fmi2GetNominalsOfContinuousStates(c, x, states) == fmi2OK, "nominal values can be read");
  expect(fmi2CompletedIntegratorStep(c, fmi2True, &wanted, &ends) == fmi2OK, "a step can be completed");
  return wanted;
}

void Session::exchange() {
  const fmi2Component c = make_instance(fmi2ModelExchange);
  double t = 0;
  choose(c, in_);
  fmi2EnterInitializationMode(c);
  bool lasts = fmi2ExitInitializationMode(c) == fmi2OK && decide(c);
  if (lasts) expect(fmi2EnterContinuousTimeMode(c) == fmi2OK, "the run begins");
  for (unsigned k = in_.below(12); k > 0 && lasts; --k) {
    if (in_.chance(4)) set_input(c, in_);
    const double h = 0.01 * in_.factor();
    expect(fmi2SetTime(c, t += h) == fmi2OK, "a finite time is taken");
    const bool wanted = move_freely(c, h, in_);
    if (in_.chance(2)) save_and_restore(c);
    if (!wanted && !in_.chance(2)) continue;
    expect(fmi2EnterEventMode(c) == fmi2OK, "event mode can be entered");
    lasts = decide(c);
    if (lasts) expect(fmi2EnterContinuousTimeMode(c) == fmi2OK, "and left");
  }
  if (in_.chance(4)) bring_forged(c, make_instance(fmi2ModelExchange), fmi2ModelExchange, in_);
  expect(fmi2Reset(c) == fmi2OK, "reset succeeds");
  fmi2FreeInstance(c);
}

}  // namespace fuzz
