// Any instant of the free wheel, read from half a nutation by reflections and sums. Path of O as X_O + i Y_O.
#include "orbit.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace orbit {

bool Track::add(const solver::Step& step) {
  if (count_ == most_pieces || step.degree > degree) return false;
  if (count_ % more_pieces == 0) {
    Piece* const shorter = pieces_.release();
    void* const longer = std::realloc(shorter, (count_ + more_pieces) * sizeof(Piece));
    pieces_.reset(longer ? static_cast<Piece*>(longer) : shorter);
    if (!longer) return false;
  }
  Piece& piece = pieces_.get()[count_++] = {step.start, step.end, {}};
  for (int k = 0; k <= step.degree; ++k) std::copy_n(step.c[k], states, piece.c[k]);
  return true;
}

void Track::read(double t, double* y) const {
  const Piece* pieces = pieces_.get();
  if (!(t <= pieces[latest_].end && (latest_ == 0 || t > pieces[latest_].start))) {
    const auto before = [](const Piece& piece, double instant) { return piece.end < instant; };
    latest_ = static_cast<int>(std::lower_bound(pieces, pieces + count_ - 1, t, before) - pieces);
  }
  const Piece& piece = pieces[latest_];
  solver::evaluate<states>(piece.c, degree, (t - piece.end) / (piece.end - piece.start), y);
}

// (states at T1 and T2) => terms of the sums
void Orbit::take_half() {
  latest_half_ = {};
  read_integrated(T1_, at_T1_);
  read_integrated(T2_, at_T2_);
  psi_growth_ = at_T2_[WHEEL_PSI] - at_T1_[WHEEL_PSI];
  phi_growth_ = at_T2_[WHEEL_PHI] - at_T1_[WHEEL_PHI];
  delta_ = std::remainder(psi_growth_, std::numbers::pi);
  displacement_ = (place_of(at_T2_) - place_of(at_T1_)) * std::polar(1.0, -at_T1_[WHEEL_PSI]);
  pair_ = 2 * (displacement_ * std::polar(1.0, -delta_)).real();
  rotation_at_T1_ = std::polar(1.0, at_T1_[WHEEL_PSI]);
  mirror_rotation_ = std::polar(1.0, 2 * at_T2_[WHEEL_PSI]);
}

// (k) => the half k. The k halves before it are the integrated one and its mirror image in turn. A pair of them turns
// the path by 2 delta; with d the displacement of O in the first half, n pairs carry O by a geometric sum,
// 2 Re(d exp(-i delta)) exp(i n delta) sin(n delta) / sin(delta). Where k is odd, one half more.
Orbit::Half Orbit::half_at(double k) const {
  Half half;
  half.begin = begin_of(k);
  half.next = begin_of(k + 1);
  const double n = std::floor(0.5 * k);
  half.mirrored = k != 2 * n;
  const Complex chord = std::polar(1.0, n * delta_), pairs_rotation = chord * chord;
  const double quotient = delta_ == 0 ? n : chord.imag() / std::sin(delta_);
  Complex way = pair_ * quotient * chord;
  if (half.mirrored) way += displacement_ * pairs_rotation;
  half.place = start_.place + start_.rotation * (place_of(at_T1_) + way * rotation_at_T1_);
  half.rotation = start_.rotation * (half.mirrored ? -pairs_rotation * mirror_rotation_ : pairs_rotation);
  half.psi_sum = start_.psi_sum + (half.mirrored ? 2 * at_T2_[WHEEL_PSI] + (k - 1) * psi_growth_ : k * psi_growth_);
  half.phi_sum = start_.phi_sum + (half.mirrored ? 2 * at_T2_[WHEEL_PHI] + (k - 1) * phi_growth_ : k * phi_growth_);
  return half;
}

const Orbit::Half& Orbit::half_of(double t) const {
  if (t >= latest_half_.begin && t < latest_half_.next) return latest_half_;
  double k = std::floor((t - T1_) / (T2_ - T1_));
  if (t < begin_of(k)) k -= 1;
  if (t >= begin_of(k + 1)) k += 1;
  return latest_half_ = half_at(k);
}

// (y in the frame of the integrated half, way from the start of the half to O) => y in fixed axes
void Orbit::to_fixed(const Half& half, Complex way, double* y) {
  y[WHEEL_PSI] += half.psi_sum;
  y[WHEEL_PHI] += half.phi_sum;
  set_place(y, half.place + half.rotation * way);
}

// psi, phi and the displacement of O are proportional to the time, along a chord that turns half as fast as the wheel.
void Orbit::read_circle(double t, double* y) const {
  const double half = 0.5 * steady_rate_[WHEEL_PSI] * t,
               shortened = half == 0 ? 1 : std::sin(half) / half;  // chord over arc
  for (const int i : {WHEEL_THETA, WHEEL_OMEGA_1, WHEEL_OMEGA_2, WHEEL_OMEGA_3}) y[i] = at_T1_[i];
  y[WHEEL_PSI] = steady_rate_[WHEEL_PSI] * t;
  y[WHEEL_PHI] = steady_rate_[WHEEL_PHI] * t;
  set_place(y, place_of(steady_rate_) * (t * shortened) * std::polar(1.0, half));
}

// In the frame of the integrated motion.
void Orbit::read_integrated(double t, double* y) const {
  result_ == Result::steady ? read_circle(t, y) : track_.read(t, y);
}

void Orbit::read(double t, double* y) const {
  if (result_ != Result::unfolded || t <= T2_) {
    read_integrated(t, y);
    return to_fixed(start_, place_of(y), y);
  }
  const Half& half = half_of(t);
  const double since = std::clamp(t - half.begin, 0.0, T2_ - T1_);
  track_.read(half.mirrored ? T2_ - since : T1_ + since, y);
  Complex way = place_of(y) - place_of(half.mirrored ? at_T2_ : at_T1_);
  if (half.mirrored) {
    way = std::conj(way);
    y[WHEEL_OMEGA_1] = -y[WHEEL_OMEGA_1];
    y[WHEEL_PSI] = -y[WHEEL_PSI];
    y[WHEEL_PHI] = -y[WHEEL_PHI];
  }
  to_fixed(half, way, y);
}

}  // namespace orbit
