// Any later instant from half a nutation: reflections and sums. Path of O in fixed axes as X_O + i Y_O.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "orbit.hpp"

namespace orbit {

// What the sums need, from the states at T1 and T2, and the recurring events.
void Orbit::take_half() {
  track_.read(T1_, first_);
  track_.read(T2_, second_);
  delta_ = std::remainder(second_[psi] - first_[psi], std::numbers::pi);
  step_ = (place_of(second_) - place_of(first_)) * std::polar(1.0, -first_[psi]);
  pair_ = 2 * (step_ * std::polar(1.0, -delta_)).real();
  first_turn_ = std::polar(1.0, first_[psi]);
  mirror_turn_ = std::polar(1.0, 2 * second_[psi]);
  for (Recurrence& recurrence : recurrences_) recurrence.repeat(T1_, T2_);
}

// The falls in the two halves after T2, of which the first is mirrored.
void Orbit::Recurrence::repeat(double T1, double T2) {
  const double period = 2 * (T2 - T1);
  while (falls > 0 && fall[falls - 1] > T2) --falls;
  for (int i = rises - 1; i >= 0; --i)
    if (rise[i] > T1 && rise[i] < T2) later_fall[later_falls++] = T2 - rise[i];
  for (int i = 0; i < falls; ++i)
    if (fall[i] > T1) later_fall[later_falls++] = period - (T2 - fall[i]);
}

// The sum of k halves, each the mirror image of the one before: with d the displacement of O in the
// first, pairs add up to 2 Re(d exp(-i delta)) exp(i n delta) sin(n delta) / sin(delta), n = floor(k / 2).
Orbit::Half Orbit::half_at(double k) const {
  Half half;
  half.begin = begin_of(k);
  half.next = begin_of(k + 1);
  const double n = std::floor(0.5 * k), turn = second_[psi] - first_[psi], roll = second_[phi] - first_[phi];
  half.mirrored = k != 2 * n;
  const Complex turned = std::polar(1.0, n * delta_), pairs_turn = turned * turned;
  const double quotient = delta_ == 0 ? n : turned.imag() / std::sin(delta_);
  Complex way = pair_ * quotient * turned;
  if (half.mirrored) way += step_ * pairs_turn;
  half.place = lead_.place + lead_.turn * (place_of(first_) + way * first_turn_);
  half.turn = lead_.turn * (half.mirrored ? -pairs_turn * mirror_turn_ : pairs_turn);
  half.psi_sum = lead_.psi_sum + (half.mirrored ? 2 * second_[psi] + (k - 1) * turn : k * turn);
  half.phi_sum = lead_.phi_sum + (half.mirrored ? 2 * second_[phi] + (k - 1) * roll : k * roll);
  return half;
}

const Orbit::Half& Orbit::half_of(double t) const {
  if (t >= half_.begin && t < half_.next) return half_;
  double k = std::floor((t - T1_) / (T2_ - T1_));
  if (t < begin_of(k)) k -= 1;
  if (t >= begin_of(k + 1)) k += 1;
  return half_ = half_at(k);
}

double Orbit::fastest_turn() const {
  const double turn = std::fabs(second_[psi] - first_[psi]), roll = std::fabs(second_[phi] - first_[phi]);
  return std::fmax(turn, roll) / (T2_ - T1_);
}

// y from the frame of the integrated half to the fixed axes; way: from the half's begin to O.
void Orbit::turn_by(const Half& half, Complex way, double* y) {
  y[psi] += half.psi_sum;
  y[phi] += half.phi_sum;
  set_place(y, half.place + half.turn * way);
}

void Orbit::read(double t, double* y) const {
  if (kind_ != Kind::folded || t <= T2_) {
    track_.read(t, y);
    return turn_by(lead_, place_of(y), y);
  }
  const Half& half = half_of(t);
  const double since = std::clamp(t - half.begin, 0.0, T2_ - T1_);
  track_.read(half.mirrored ? T2_ - since : T1_ + since, y);
  Complex way = place_of(y) - place_of(half.mirrored ? second_ : first_);
  if (half.mirrored) {
    way = std::conj(way);
    y[omega_1] = -y[omega_1];
    y[psi] = -y[psi];
    y[phi] = -y[phi];
  }
  turn_by(half, way, y);
}

double Orbit::fall(int event, long long n) const {
  const Recurrence& own = recurrences_[event];
  if (n < own.falls) return own.fall[n];
  const long long periods = (n - own.falls) / own.later_falls;
  return begin_of(1 + 2 * static_cast<double>(periods)) + own.later_fall[(n - own.falls) % own.later_falls];
}

long long Orbit::falls_until(int event, double t) const {
  const auto& [falls, rises, later_falls, fall, rise, later_fall] = recurrences_[event];
  if (kind_ != Kind::folded || t <= T2_ || later_falls == 0) return std::upper_bound(fall, fall + falls, t) - fall;
  constexpr double most_periods = 1e15;  // later, times have no more digits for them
  const double periods = std::floor(std::fmin((t - T2_) / (2 * (T2_ - T1_)), most_periods));
  const double begin = begin_of(1 + 2 * periods);
  const auto is_before = [begin](double instant, double later) { return instant < begin + later; };
  const long long last = std::upper_bound(later_fall, later_fall + later_falls, t, is_before) - later_fall;
  return falls + static_cast<long long>(periods) * later_falls + last;
}

}  // namespace orbit
