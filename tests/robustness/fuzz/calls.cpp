// Life cycle, stepping and status calls, each with sound and unsound arguments.
#include <algorithm>
#include <cmath>

#include "session.hpp"

namespace fuzz {

fmi2Component make_instance(fmi2Type kind) {
  const fmi2CallbackFunctions functions = callbacks();
  const fmi2Component component = fmi2Instantiate("wheel", kind, WHEEL_GUID, nullptr, &functions, fmi2False, log().on);
  expect(component, "a sound fmi2Instantiate succeeds");
  return component;
}

void Session::instantiate() {
  if (now_->component) return;
  const unsigned flaw = in_.below(8);
  const fmi2CallbackFunctions functions = callbacks(), silent = {};
  const char* const names[] = {"100 % #1#", " \t", nullptr, ""};
  const char* const name = names[flaw < 4 ? flaw : 0];
  const char* const guid = flaw == 4 ? "{0}" : flaw == 5 ? nullptr : WHEEL_GUID;
  const fmi2Component component =
      fmi2Instantiate(name, fmi2CoSimulation, guid, "file:///x", flaw == 6 ? &silent : &functions, fmi2False, log().on);
  expect((component == nullptr) == (flaw >= 1 && flaw <= 5), "only sound arguments give an instance");
  if (flaw == 6) {
    fmi2FreeInstance(component);
    freed_ = component;
  } else {
    *now_ = {component, {}};
  }
}

void Session::free_instance() {
  for (const Slot& slot : slots_)
    if (slot.component == freed_ || log().shared) freed_ = nullptr;  // its place in memory may live again
  expect(fmi2Terminate(freed_) == fmi2Error, "an instance that is gone cannot be terminated");
  fmi2FreeInstance(freed_);
  if (!now_->component) return;
  freed_ = now_->component;
  fmi2FreeInstance(freed_);
  *now_ = {};
}

void Session::set_up_experiment() {
  const bool has_tolerance = in_.chance(8), has_stop = in_.chance(4);
  const double tolerance = in_.chance(12) ? std::pow(10.0, -3.0 - in_.below(11)) : in_.any();
  const double start = in_.chance(12) ? 0 : in_.any();
  const double stop = in_.chance(12) ? start + 100 * in_.factor() : in_.any();
  const fmi2Status status = checked(
      *now_, I, [&] { return fmi2SetupExperiment(now_->component, has_tolerance, tolerance, start, has_stop, stop); });
  const bool sound = std::isfinite(start) && (!has_stop || stop >= start) && (!has_tolerance || tolerance > 0);
  if (now_->model.state != instantiated) return;
  expect((status == fmi2Error) == !sound, "only a sound experiment is accepted");
  if (status == fmi2Error) return;
  now_->model.tolerance = has_tolerance ? std::clamp(tolerance, 1e-13, 1e-4) : 1e-8;
  now_->model.has_stop = has_stop;
  now_->model.stop = stop;
}

void Session::enter_initialization() {
  const fmi2Status status = checked(*now_, I, [&] { return fmi2EnterInitializationMode(now_->component); });
  if (status == fmi2OK) now_->model.state = initialization;
}

void Session::exit_initialization() {
  const bool legal = now_->model.state == initialization;
  const fmi2Status status = checked(*now_, M, [&] { return fmi2ExitInitializationMode(now_->component); }, true);
  if (!legal) return;
  now_->model.state = status == fmi2OK ? step_complete : error;
  if (status == fmi2OK) check_after_start(*now_);
}

void Session::terminate() {
  if (checked(*now_, C | F, [&] { return fmi2Terminate(now_->component); }) == fmi2OK) now_->model.state = terminated;
}

void Session::reset() {
  expect(checked(*now_, anywhere, [&] { return fmi2Reset(now_->component); }) == fmi2OK, "reset succeeds");
  now_->model = {};
}

double short_step(fmi2Component c) {
  constexpr double longest = 10, share = 0.25;  // s, and of the shortest time
  const unsigned references[] = {ref_r_0, ref_r, ref_g, ref_psi_dot, ref_theta_dot, ref_phi_dot};
  double v[6] = {};
  if (fmi2GetReal(c, references, 6, v) != fmi2OK) return 0.01;
  const double rate = std::sqrt(v[2] / (v[0] + v[1])) + std::fabs(v[3]) + std::fabs(v[4]) + std::fabs(v[5]);
  return rate > 0 && std::isfinite(rate) ? std::min(share / rate, longest) : 0.01;
}

double Session::usual_step(const Slot& slot) {
  return slot.model.state == instantiated ? 0.01 : short_step(slot.component);
}

// Keeps the model of the call state; t is expected to be the present time, h a sound step.
fmi2Status Session::step(Slot& slot, double t, double h) {
  const bool legal = slot.model.state == step_complete;
  const bool beyond = slot.model.has_stop && t + h > slot.model.stop;
  if (beyond) h = std::max(slot.model.stop - t, 0.0);
  const fmi2Status status = checked(slot, C, [&] { return fmi2DoStep(slot.component, t, h, fmi2True); }, true);
  trace("  %.17g + %.17g: %d\n", t, h, status);
  if (!legal) return status;
  if (status == fmi2Error) {
    slot.model.state = error;
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
  check_after_step(slot);
  return status;
}

void Session::do_step() {
  const bool running = now_->model.state == step_complete || now_->model.state == step_failed;
  const double t = running ? time_of(now_->component) : 0, h = usual_step(*now_) * in_.factor();
  const unsigned flaw = in_.below(8);
  if (flaw < 3) {
    step(*now_, t, flaw == 0 ? h : flaw == 1 ? 0 : h * 1e-9);
    return;
  }
  const double nan = std::nan(""), infinite = HUGE_VAL;
  const double wrong_t[] = {nan, infinite, t + 1 + std::fabs(t), t, t}, wrong_h[] = {h, h, h, -h, nan};
  const fmi2Status status =
      checked(*now_, C, [&] { return fmi2DoStep(now_->component, wrong_t[flaw - 3], wrong_h[flaw - 3], fmi2True); });
  expect(status == fmi2Error, "a step from or to a senseless time is refused");
}

void Session::ask_status() {
  const unsigned kind = in_.below(4);
  const bool null = in_.chance(2);
  constexpr unsigned legal = C | F | T;
  fmi2Status status;
  fmi2Real real;
  fmi2Integer whole;
  fmi2Boolean truth;
  fmi2String text;
  const auto k = static_cast<fmi2StatusKind>(kind);
  const fmi2Component c = now_->component;
  checked(*now_, legal, [&] { return fmi2GetStatus(c, k, null ? nullptr : &status); });
  checked(*now_, legal, [&] { return fmi2GetRealStatus(c, k, null ? nullptr : &real); });
  checked(*now_, legal, [&] { return fmi2GetIntegerStatus(c, k, null ? nullptr : &whole); });
  checked(*now_, legal, [&] { return fmi2GetBooleanStatus(c, k, null ? nullptr : &truth); });
  checked(*now_, legal, [&] { return fmi2GetStringStatus(c, k, null ? nullptr : &text); });
}

void Session::switch_logging() {
  const fmi2String categories[] = {"logAll", "logStatusError", "nonsense %s", nullptr, "logEvents"};
  const unsigned count = in_.below(6);
  const bool on = in_.chance(8), null = in_.chance(2), was_on = log().on;
  log().on = false;  // whether this call's own faults are told depends on what it switches
  checked(*now_, anywhere,
          [&] { return fmi2SetDebugLogging(now_->component, on, count, null ? nullptr : categories); });
  log().on = was_on && fmi2SetDebugLogging(now_->component, fmi2True, 0, nullptr) == fmi2OK;
}

}  // namespace fuzz
