// FMI 2.0 functions: stepping and status.
#include <bit>
#include <cmath>

#include "instance.hpp"
#include "motion.hpp"

using fmi::guarded, fmi::Instance, wheel::Topic;
namespace legality = fmi::legality;

namespace {

// Masters compute times with rounding errors. Times that differ by this much, relative to the step and to the times
// themselves, count as equal.
constexpr double step_rounding = 1e-9, time_rounding = 1e-13;
// Of the step: how much of it may be lost in the rounding of the time reached.
constexpr double step_digits = 0.1;

// (times, step) => whether they count as equal
bool same_time(double a, double b, double step) {
  return std::fabs(a - b) <= step_rounding * step + time_rounding * (std::fabs(a) + std::fabs(b));
}

// The sum of many steps carries more rounding errors than one step.
bool is_past(double t, double stop) { return t - stop > step_rounding * (std::fabs(t) + std::fabs(stop)); }

bool check_step(const Instance& i, double t, double h) {
  const double reached = i.wheel.time(), stop = i.wheel.demand.stop_time;
  return i.check(std::isfinite(t) && std::isfinite(h) && h >= 0,
                 "%s from %s s by %s s: times must be finite and the step not negative.", t, h) &&
         i.check(std::fabs(t + h - t - h) <= step_digits * h,
                 "%s from %s s by %s s: the step is lost in the rounding of the time.", t, h) &&
         i.check(same_time(t, reached, h), "%s from %s s: the FMU has reached %s s.", t, reached) &&
         i.check(!is_past(t + h, stop), "%s to %s s: the stop time is %s s.", t + h, stop);
}

bool check_inputs(const Instance& i, double h) {
  const wheel::Excess excess = wheel::excess_of(i.wheel, h);
  const wheel::Limit& limit = excess.limit;
  return i.check(!limit.relation, "%s by %s s: %s would become %s: it must be %s %s.", h,
                 wheel::row_of(excess.input).name, wheel::Digits{excess.value, 9}, limit.relation,
                 wheel::Digits{limit.value, 6});
}

constexpr long long no_status = 0x100000000;  // beyond what a caller can pass

// Each function has one kind of status and answers every other kind with Discard, numbers outside of the enumeration
// too, which cannot be read as its type.
template <class Value, class Read>
auto get_status(const fmi2StatusKind& asked, long long known_kind, Value* value, Read read) {
  const int kind = std::bit_cast<int>(asked);
  return [=](Instance& i) {
    if (!value) return i.log(Topic::error, "%s: the value is a null pointer.");
    if (kind != known_kind) return i.log(Topic::discard, "%s: there is no status of kind %d.", kind);
    *value = read(i);
    return fmi2OK;
  };
}

}  // namespace

fmi2Status fmi2DoStep(fmi2Component c, fmi2Real t, fmi2Real h, fmi2Boolean) {
  return guarded(c, legality::do_step, [=](Instance& i) {
    if (!check_step(i, t, h) || !check_inputs(i, h)) return fmi2Error;
    const wheel::Progress progress = wheel::advance(i.change(), t + h - i.wheel.demand.start_time);
    if (progress == wheel::Progress::failed) return fmi2Error;
    return progress == wheel::Progress::ended ? fmi2Discard : fmi2OK;
  });
}

fmi2Status fmi2CancelStep(fmi2Component c) {
  return guarded(c, legality::cancel_step, [](Instance&) { return fmi2Error; });
}

fmi2Status fmi2GetStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Status* value) {
  const auto read = [](Instance& i) { return i.wheel.has_ended() ? fmi2Discard : fmi2OK; };
  return guarded(c, legality::get_status, get_status(kind, fmi2DoStepStatus, value, read));
}

fmi2Status fmi2GetRealStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Real* value) {
  const auto read = [](Instance& i) { return i.wheel.time(); };
  return guarded(c, legality::get_status, get_status(kind, fmi2LastSuccessfulTime, value, read));
}

fmi2Status fmi2GetIntegerStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Integer* value) {
  return guarded(c, legality::get_status, get_status(kind, no_status, value, [](Instance&) { return 0; }));
}

fmi2Status fmi2GetBooleanStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Boolean* value) {
  const auto read = [](Instance& i) { return i.wheel.has_ended() ? fmi2True : fmi2False; };
  return guarded(c, legality::get_status, get_status(kind, fmi2Terminated, value, read));
}

fmi2Status fmi2GetStringStatus(fmi2Component c, const fmi2StatusKind kind, fmi2String* value) {
  return guarded(c, legality::get_status, get_status(kind, fmi2PendingStatus, value, [](Instance&) { return ""; }));
}
