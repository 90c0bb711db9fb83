// Model exchange: an instance of its own, moved by hand through any states, inputs and events, with what must hold.
#include <algorithm>
#include <cmath>

#include "session.hpp"

namespace fuzz {
namespace {

constexpr int states = 8, indicators = 4;

struct Wheel {
  fmi2Component component = nullptr;
  double t = 0, x[states] = {};
};

fmi2Component make_wheel(Bytes& in) {
  const fmi2Component c = make_instance(fmi2ModelExchange);
  const unsigned choices[] = {ref_friction_law, ref_formulation}, reals[] = {ref_s, ref_J_x, ref_slope};
  const int picked[] = {1 + static_cast<int>(in.below(2)), 1 + static_cast<int>(in.below(3))};
  const double values[] = {in.chance(8) ? 0.03 : 0.0, in.chance(8) ? 0.9 : 1.0, in.chance(4) ? 0.2 : 0.0};
  const unsigned keep = ref_keep_contact;
  const int kept = in.chance(8);
  fmi2SetInteger(c, choices, 2, picked);
  fmi2SetReal(c, reals, 3, values);
  fmi2SetBoolean(c, &keep, 1, &kept);
  return c;
}

// True while the model lasts.
bool decide(Wheel& wheel) {
  fmi2EventInfo info = {};
  expect(fmi2NewDiscreteStates(wheel.component, &info) == fmi2OK, "event mode decides");
  expect(!info.newDiscreteStatesNeeded, "one pass is enough");
  expect(fmi2GetContinuousStates(wheel.component, wheel.x, states) == fmi2OK, "states can be read");
  return !info.terminateSimulation;
}

// Euler's step, or anywhere.
void move(Wheel& wheel, Bytes& in) {
  double rates[states];
  const fmi2Status status = fmi2GetDerivatives(wheel.component, rates, states);
  expect(status == fmi2OK || status == fmi2Discard, "derivatives are given or discarded");
  const double h = 0.01 * in.factor();
  for (int i = 0; i < states; ++i) {
    if (status == fmi2OK) expect(std::isfinite(rates[i]), "a derivative is finite");
    if (status == fmi2OK) wheel.x[i] += h * rates[i];
    if (in.chance(1)) wheel.x[i] = in.any();
  }
  wheel.t += h;
  expect(fmi2SetTime(wheel.component, wheel.t) == fmi2OK, "a finite time is taken");
  double back[states];
  if (fmi2SetContinuousStates(wheel.component, wheel.x, states) == fmi2OK) {
    expect(fmi2GetContinuousStates(wheel.component, back, states) == fmi2OK, "states can be read");
    expect(std::equal(back, back + states, wheel.x), "states are read back to the bit");
  } else {
    expect(!std::all_of(wheel.x, wheel.x + states, [](double v) { return std::isfinite(v); }),
           "finite states are taken");
    fmi2GetContinuousStates(wheel.component, wheel.x, states);
  }
}

void save_and_restore(const Wheel& wheel) {
  fmi2FMUstate state = nullptr;
  double before[states], after[states];
  const fmi2Status first = fmi2GetDerivatives(wheel.component, before, states);
  expect(fmi2GetFMUstate(wheel.component, &state) == fmi2OK, "a state can be taken");
  expect(fmi2SetFMUstate(wheel.component, state) == fmi2OK, "a state that was handed out is restored");
  expect(fmi2GetDerivatives(wheel.component, after, states) == first, "a restored state gives the same answer");
  if (first == fmi2OK) expect(std::equal(before, before + states, after), "a restored state gives the same bits");
  expect(fmi2FreeFMUstate(wheel.component, &state) == fmi2OK, "a state can be freed");
}

void set_input(const Wheel& wheel, Bytes& in) {
  const unsigned input = ref_first_input + in.below(input_count), s = ref_s;
  const double value = in.any(), friction = in.chance(8) ? 0.02 : 0;
  fmi2SetReal(wheel.component, &input, 1, &value);
  if (in.chance(4)) expect(fmi2SetReal(wheel.component, &s, 1, &friction) == fmi2OK, "s is tunable");
}

bool event(Wheel& wheel) {
  expect(fmi2EnterEventMode(wheel.component) == fmi2OK, "event mode can be entered");
  if (!decide(wheel)) return false;
  expect(fmi2EnterContinuousTimeMode(wheel.component) == fmi2OK, "and left");
  return true;
}

}  // namespace

void Session::exchange() {
  Wheel wheel = {make_wheel(in_), 0, {}};
  const fmi2Component c = wheel.component;
  fmi2EnterInitializationMode(c);
  bool lasts = fmi2ExitInitializationMode(c) == fmi2OK && decide(wheel);
  if (lasts) expect(fmi2EnterContinuousTimeMode(c) == fmi2OK, "the run begins");
  for (unsigned k = in_.below(12); k > 0 && lasts; --k) {
    double z[indicators];
    fmi2Boolean wanted = fmi2False, ends = fmi2False;
    if (in_.chance(4)) set_input(wheel, in_);
    move(wheel, in_);
    const bool given = fmi2GetEventIndicators(c, z, indicators) == fmi2OK;
    expect(given == std::all_of(z, z + indicators, [](double v) { return std::isfinite(v); }), "indicators are finite");
    expect(fmi2CompletedIntegratorStep(c, fmi2True, &wanted, &ends) == fmi2OK, "a step can be completed");
    if (in_.chance(2)) save_and_restore(wheel);
    if (wanted || in_.chance(2)) lasts = event(wheel);
  }
  expect(fmi2Reset(c) == fmi2OK, "reset succeeds");
  fmi2FreeInstance(c);
}

}  // namespace fuzz
