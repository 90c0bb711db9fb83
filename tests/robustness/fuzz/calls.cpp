// Single calls, with sound and unsound arguments.
#include <algorithm>
#include <cmath>
#include <iterator>

#include "session.hpp"

namespace fuzz {
double Session::drawn_step() {
  return (now_->model.state == instantiated ? 0.01 : short_step(now_->component)) * in_.factor();
}

double short_step(fmi2Component c) {
  constexpr double longest = 10, share = 0.25;  // s, and of the shortest time
  const unsigned references[] = {ref_r_0, ref_r, ref_g, ref_psi_dot, ref_theta_dot, ref_phi_dot};
  double v[6] = {};
  if (fmi2GetReal(c, references, 6, v) != fmi2OK) return 0.01;
  const double rate = std::sqrt(v[2] / (v[0] + v[1])) + std::fabs(v[3]) + std::fabs(v[4]) + std::fabs(v[5]);
  return rate > 0 && std::isfinite(rate) ? std::min(share / rate, longest) : 0.01;
}

// ---- life ----

fmi2Component make_instance(fmi2Type kind) {
  const fmi2CallbackFunctions functions = callbacks();
  const fmi2Component component = fmi2Instantiate("wheel", kind, WHEEL_GUID, nullptr, &functions, fmi2False, log().on);
  expect(component, "a sound fmi2Instantiate succeeds");
  return component;
}

void choose(fmi2Component c, Bytes& in) {
  constexpr unsigned integers[] = {ref_formulation, ref_friction_law, ref_method}, keep = ref_keep_contact;
  constexpr unsigned reals[] = {ref_s, ref_J_x, ref_slope, ref_M_3, ref_M_brake};
  const int picked[] = {1 + static_cast<int>(in.below(3)), 1 + static_cast<int>(in.below(2)),
                        1 + static_cast<int>(in.below(4))};
  const double values[] = {in.chance(8) ? 0.03 : 0, in.chance(8) ? 0.9 : 1, in.chance(4) ? 0.2 : 0,
                           in.chance(4) ? 0.2 : 0, in.chance(4) ? 0.1 : 0};
  const int kept = in.chance(8);
  fmi2SetInteger(c, integers, 3, picked);
  fmi2SetReal(c, reals, 5, values);
  fmi2SetBoolean(c, &keep, 1, &kept);
}

void Session::instantiate() {
  if (!now_->component) *now_ = {make_instance(), {}};
}

void Session::free_instance() {
  fmi2FreeInstance(now_->component);
  *now_ = {};
}

void Session::set_up_experiment() {
  const bool has_tolerance = in_.chance(8), has_stop = in_.chance(4);
  const double tolerance = in_.chance(12) ? std::pow(10.0, -3.0 - in_.below(11)) : in_.any();
  const double start = in_.chance(12) ? 0 : in_.any();
  const double stop = in_.chance(12) ? start + 100 * in_.factor() : in_.any();
  const fmi2Status status = call(I, fmi2SetupExperiment, has_tolerance, tolerance, start, has_stop, stop);
  const bool sound = std::isfinite(start) && (!has_stop || stop >= start) && (!has_tolerance || tolerance > 0);
  if (now_->model.state != instantiated) return;
  expect((status == fmi2Error) == !sound, "only a sound experiment is accepted");
  if (status == fmi2Error) return;
  now_->model.has_stop = has_stop;
  now_->model.stop = stop;
}

void Session::enter_initialization() {
  if (call(I, fmi2EnterInitializationMode) == fmi2OK) now_->model.state = initialization;
}

void Session::exit_initialization() {
  const bool legal = now_->model.state == initialization;
  const fmi2Status status = call(M | may_fail, fmi2ExitInitializationMode);
  if (!legal) return;
  now_->model.state = status == fmi2OK ? step_complete : error;
  if (status == fmi2OK) check_finite(readings(*now_));
}

// From wherever the instance is to step complete, if its parameters allow.
void Session::start_quickly() {
  if (!now_->component) *now_ = {make_instance(), {}};
  if (now_->model.state == instantiated) {
    if (in_.chance(8)) choose(now_->component, in_);
    enter_initialization();
  }
  if (now_->model.state == initialization) exit_initialization();
}

void Session::terminate() {
  if (call(C | F, fmi2Terminate) == fmi2OK) now_->model.state = terminated;
}

void Session::reset() {
  expect(call(anywhere, fmi2Reset) == fmi2OK, "reset succeeds");
  now_->model = {};
}

// ---- steps ----

// Keeps the model of the call state; t is expected to be the present time, h a sound step.
fmi2Status Session::step(Slot& slot, double t, double h) {
  const bool legal = slot.model.state == step_complete;
  const bool beyond = slot.model.has_stop && t + h > slot.model.stop;
  if (beyond) h = std::max(slot.model.stop - t, 0.0);
  const fmi2Status status = checked(slot, C | may_fail, fmi2DoStep, t, h, fmi2True);
  trace("  %.17g + %.17g: %d\n", t, h, status);
  if (!legal) return status;
  if (status == fmi2Error) {  // at a far start the step can be lost in the rounding of the time: the call is refused
    if (std::fabs(t + h - t - h) <= 0.1 * h) slot.model.state = error;
    return status;
  }
  if (status == fmi2Discard) {
    fmi2Boolean ended = fmi2False;
    slot.model.state = step_failed;
    expect(fmi2GetBooleanStatus(slot.component, fmi2Terminated, &ended) == fmi2OK && ended, "Discard is an ending");
    expect(fmi2DoStep(slot.component, t, h, fmi2True) == fmi2Error, "nothing follows an ending");
  }
  const double reached = time_of(slot.component), rounding = 1e-8 * (std::fabs(t) + h);
  expect(reached >= t - rounding && reached <= t + h + rounding, "the time reached lies within the step");
  expect(status == fmi2Discard || reached >= t + h - rounding, "an accepted step reaches its end");
  check_finite(readings(slot));
  return status;
}

void Session::step_often() {
  const unsigned count = 1 + in_.below(8);
  const double h = drawn_step();
  for (unsigned k = 0; k < count && now_->model.state == step_complete; ++k) step(*now_, time_of(now_->component), h);
}

void Session::do_step() {
  const bool has_time = now_->model.state == step_complete || now_->model.state == step_failed;
  const double t = has_time ? time_of(now_->component) : 0, h = drawn_step(), nan = std::nan("");
  const unsigned flaw = in_.below(8);
  const double times[] = {t, t, t, nan, HUGE_VAL, t + 1 + std::fabs(t), t, t};
  const double steps[] = {h, 0, h * 1e-9, h, h, h, -h, nan};
  if (flaw < 3) {
    step(*now_, times[flaw], steps[flaw]);
  } else {
    const fmi2Status status = call(C, fmi2DoStep, times[flaw], steps[flaw], fmi2True);
    expect(status == fmi2Error, "a step from or to a senseless time is refused");
  }
}

// ---- values, status and log ----

template <unsigned legal_in, auto* function>
void Session::with_drawn() {
  with_drawn(legal_in, function);
}

template <class... Parameters>
void Session::with_drawn(unsigned legal_in, fmi2Status (*function)(fmi2Component, Parameters...)) {
  Arguments arguments(in_);
  const std::tuple<Parameters...> drawn{arguments.draw<Parameters>()...};
  const fmi2Status status = std::apply([&](auto... each) { return call(legal_in, function, each...); }, drawn);
  if (status != fmi2OK) return;
  if (legal_in & finite)
    for (const double value : arguments.reals()) expect(std::isfinite(value), "a derivative is finite");
}

// Calls that take arrays, or nothing but a kind of status: all arguments drawn by their types.
void Session::pass_values() {
  constexpr unsigned running = C | F | T | X, readable = M | running, ended = C | F | T;
  constexpr void (Session::* calls[])() = {&Session::with_drawn<settable, fmi2SetReal>,
                                           &Session::with_drawn<settable, fmi2SetInteger>,
                                           &Session::with_drawn<settable, fmi2SetBoolean>,
                                           &Session::with_drawn<settable, fmi2SetString>,
                                           &Session::with_drawn<settable, fmi2SetRealInputDerivatives>,
                                           &Session::with_drawn<readable, fmi2GetReal>,
                                           &Session::with_drawn<readable, fmi2GetInteger>,
                                           &Session::with_drawn<readable, fmi2GetBoolean>,
                                           &Session::with_drawn<readable, fmi2GetString>,
                                           &Session::with_drawn<readable | finite, fmi2GetDirectionalDerivative>,
                                           &Session::with_drawn<running | finite, fmi2GetRealOutputDerivatives>,
                                           &Session::with_drawn<ended, fmi2GetStatus>,
                                           &Session::with_drawn<ended, fmi2GetRealStatus>,
                                           &Session::with_drawn<ended, fmi2GetIntegerStatus>,
                                           &Session::with_drawn<ended, fmi2GetBooleanStatus>,
                                           &Session::with_drawn<ended, fmi2GetStringStatus>};
  const unsigned chosen = in_.below(std::size(calls));
  trace("  number %u\n", chosen);
  (this->*calls[chosen])();
}

void Session::switch_logging() {
  std::vector<fmi2String> categories = {"logAll", "logStatusError", "nonsense %s", nullptr, "logEvents"};
  const unsigned count = in_.below(6);
  const bool on = in_.chance(8), was_on = log().on;
  log().on = false;  // whether this call's own faults are logged depends on what it switches
  call(anywhere, fmi2SetDebugLogging, on, count, in_.array(categories));
  log().on = was_on && fmi2SetDebugLogging(now_->component, fmi2True, 0, nullptr) == fmi2OK;
}

}  // namespace fuzz
