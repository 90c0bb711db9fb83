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
  T1_ = T1;
  half_ = T2 - T1;
  while (falls_ > 0 && fall_[falls_ - 1] > T2) --falls_;
  for (int i = rises_ - 1; i >= 0; --i)
    if (rise_[i] > T1 && rise_[i] < T2) later_fall_[later_falls_++] = T2 - rise_[i];
  for (int i = 0; i < falls_; ++i)
    if (fall_[i] > T1) later_fall_[later_falls_++] = 2 * half_ - (T2 - fall_[i]);
}

double Recurrence::fall(long long n) const {
  if (n < falls_) return fall_[n];
  const long long periods = (n - falls_) / later_falls_;
  return begin_of(static_cast<double>(periods)) + later_fall_[(n - falls_) % later_falls_];
}

long long Recurrence::falls_until(double t) const {
  const double T2 = T1_ + half_;
  if (later_falls_ == 0 || t <= T2) return std::upper_bound(fall_, fall_ + falls_, t) - fall_;
  constexpr double most_periods = 1e15;  // later, times have no more digits for them
  const double periods = std::floor(std::fmin((t - T2) / (2 * half_), most_periods)), begin = begin_of(periods);
  const auto is_before = [begin](double instant, double later) { return instant < begin + later; };
  const long long last = std::upper_bound(later_fall_, later_fall_ + later_falls_, t, is_before) - later_fall_;
  return falls_ + static_cast<long long>(periods) * later_falls_ + last;
}

}  // namespace orbit
