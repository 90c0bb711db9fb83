// FMI 2.0 functions of model exchange: the caller's solver asks for derivatives, event indicators and events.
#include <algorithm>
#include <cmath>

#include "exchange.hpp"
#include "instance.hpp"
#include "setting.hpp"

using fmi::guarded, fmi::Instance, fmi::no_fault, wheel::Phase, wheel::Topic;
namespace legality = fmi::legality;

namespace {

bool check_count(Instance& i, const void* values, std::size_t count, int needed) {
  return i.check(values && count == static_cast<std::size_t>(needed), "%s: needs an array of %d numbers, not of %zu%s.",
                 needed, count, values ? "" : ", and it is a null pointer");
}

bool are_finite(const double* values, std::size_t count) {
  return std::all_of(values, values + count, [](double value) { return std::isfinite(value); });
}

// Reads as many numbers as are needed, in initialization mode from the start values; Discard where they are not finite.
template <class Read>
auto read_numbers(fmi2Real values[], std::size_t count, int needed, const char* what, Read read) {
  return [=](Instance& i) {
    if (!check_count(i, values, count, needed)) return fmi2Error;
    if (!wheel::prepare_once(i.change()) || !has_state(i.wheel.run.phase)) return fmi2Discard;
    read(i.change(), values);
    if (are_finite(values, count)) return fmi2OK;
    return i.log(Topic::discard, "%s: at t = %s s the %s are not finite.", i.wheel.time(), what);
  };
}

}  // namespace

fmi2Status fmi2EnterEventMode(fmi2Component c) {
  return guarded(c, legality::while_integrating, [](Instance& i) { wheel::enter_mode(i.change(), Phase::event_mode); });
}

fmi2Status fmi2EnterContinuousTimeMode(fmi2Component c) {
  return guarded(c, legality::enter_continuous_time,
                 [](Instance& i) { wheel::enter_mode(i.change(), Phase::continuous_time); });
}

// One pass is enough: the law that is decided holds.
fmi2Status fmi2NewDiscreteStates(fmi2Component c, fmi2EventInfo* info) {
  return guarded(c, legality::new_discrete_states, [=](Instance& i) {
    if (!info) return "the event info is a null pointer";
    *info = {};
    info->valuesOfContinuousStatesChanged = wheel::decide_in_event_mode(i.change()) ? fmi2True : fmi2False;
    info->terminateSimulation = i.wheel.has_ended() ? fmi2True : fmi2False;
    return no_fault;
  });
}

fmi2Status fmi2CompletedIntegratorStep(fmi2Component c, fmi2Boolean, fmi2Boolean* enter_event_mode,
                                       fmi2Boolean* terminate) {
  return guarded(c, legality::while_integrating, [=](Instance& i) {
    if (!enter_event_mode || !terminate) return "a result is a null pointer";
    *enter_event_mode = wheel::has_event(i.change()) ? fmi2True : fmi2False;
    *terminate = fmi2False;
    return no_fault;
  });
}

fmi2Status fmi2SetTime(fmi2Component c, fmi2Real t) {
  return guarded(c, legality::set_time, [=](Instance& i) {
    if (!std::isfinite(t)) return i.log(Topic::error, "%s: %s s: the time must be finite.", t);
    wheel::set_time(i.change(), t);
    return fmi2OK;
  });
}

fmi2Status fmi2SetContinuousStates(fmi2Component c, const fmi2Real x[], size_t n) {
  return guarded(c, legality::while_integrating, [=](Instance& i) {
    if (!check_count(i, x, n, wheel::state_count)) return fmi2Error;
    if (!are_finite(x, n)) return i.log(Topic::discard, "%s: a state is not finite.");
    wheel::try_states(i.change(), x);
    return fmi2OK;
  });
}

fmi2Status fmi2GetContinuousStates(fmi2Component c, fmi2Real x[], size_t n) {
  return guarded(c, legality::get_states, read_numbers(x, n, wheel::state_count, "states", wheel::read_states));
}

fmi2Status fmi2GetNominalsOfContinuousStates(fmi2Component c, fmi2Real x[], size_t n) {
  return guarded(c, legality::get_states, read_numbers(x, n, wheel::state_count, "nominals", wheel::read_nominals));
}

fmi2Status fmi2GetDerivatives(fmi2Component c, fmi2Real x_dot[], size_t n) {
  return guarded(c, legality::get_states,
                 read_numbers(x_dot, n, wheel::state_count, "derivatives", wheel::read_derivatives));
}

fmi2Status fmi2GetEventIndicators(fmi2Component c, fmi2Real z[], size_t n) {
  return guarded(c, legality::get_states,
                 read_numbers(z, n, wheel::indicator_count(), "indicators", wheel::read_indicators));
}
