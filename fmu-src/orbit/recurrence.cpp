// Instants of a recurring event. In the half from T2 on the function is mirrored, so it falls where it rose before.
#include "recurrence.hpp"

#include <algorithm>
#include <cmath>

namespace orbit {

bool Recurrence::take(double t) {
  const bool falls = falls_ == rises_;
  int& count = falls ? falls_ : rises_;
  if (count == most_crossings) return false;
  (falls ? fall_ : rise_)[count++] = t;
  return true;
}

// The falls in the two halves after T2, of which the first is mirrored.
void Recurrence::repeat(double T1, double T2) {
  T2_ = T2;
  period_ = 2 * (T2 - T1);
  while (falls_ > 0 && fall_[falls_ - 1] > T2) --falls_;
  for (int i = rises_ - 1; i >= 0; --i)
    if (rise_[i] > T1 && rise_[i] < T2) fall_[falls_ + later_falls_++] = 2 * T2 - rise_[i];
  for (int i = 0; i < falls_; ++i)
    if (fall_[i] > T1) fall_[falls_ + later_falls_++] = fall_[i] + period_;
}

double Recurrence::fall(long long n) const {
  const long long periods = n < falls_ ? 0 : (n - falls_) / later_falls_;
  return fall_[n - periods * later_falls_] + static_cast<double>(periods) * period_;
}

long long Recurrence::falls_until(double t) const {
  constexpr double most_periods = 1e15;  // later, times have no more digits for them
  const bool repeats = later_falls_ > 0 && t > T2_;
  const double periods = repeats ? std::floor(std::fmin((t - T2_) / period_, most_periods)) : 0;
  const auto is_before = [&](double instant, double fall) { return instant < fall + periods * period_; };
  const long long last = std::upper_bound(fall_, fall_ + falls_ + later_falls_, t, is_before) - fall_;
  return static_cast<long long>(periods) * later_falls_ + last;
}

}  // namespace orbit
