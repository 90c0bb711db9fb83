// Any instant of the free wheel, read from half a swing by reflections and sums.
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

// psi, phi and the displacement of O are proportional to the time, along a chord that turns half as fast as the wheel.
void Circle::read(double t, double* y) const {
  const double half = 0.5 * rate[WHEEL_PSI] * t, shortened = half == 0 ? 1 : std::sin(half) / half;  // chord over arc
  for (const int i : {WHEEL_THETA, WHEEL_OMEGA_1, WHEEL_OMEGA_2, WHEEL_OMEGA_3}) y[i] = y0[i];
  y[WHEEL_PSI] = rate[WHEEL_PSI] * t;
  y[WHEEL_PHI] = rate[WHEEL_PHI] * t;
  set_place(y, place_of(rate) * (t * shortened) * std::polar(1.0, half));
}

void Course::read(double t, double* y) const {
  if (const Track* const track = std::get_if<Track>(&path)) return track->read(t, y);
  if (const Circle* const circle = std::get_if<Circle>(&path)) circle->read(t, y);
}

void Pose::carry(Complex way, double* y) const {
  y[WHEEL_PSI] += psi;
  y[WHEEL_PHI] += phi;
  set_place(y, place + rotation * way);
}

Swing::Swing(Course&& course) : course_(std::move(course)) {
  if (course_.ending) return;
  course_.read(course_.T1, at_T1_);
  course_.read(course_.T2, at_T2_);
  psi_growth_ = at_T2_[WHEEL_PSI] - at_T1_[WHEEL_PSI];
  phi_growth_ = at_T2_[WHEEL_PHI] - at_T1_[WHEEL_PHI];
  delta_ = std::remainder(psi_growth_, std::numbers::pi);
  displacement_ = (place_of(at_T2_) - place_of(at_T1_)) * std::polar(1.0, -at_T1_[WHEEL_PSI]);
  pair_advance_ = 2 * (displacement_ * std::polar(1.0, -delta_)).real();
  rotation_at_T1_ = std::polar(1.0, at_T1_[WHEEL_PSI]);
  mirror_rotation_ = std::polar(1.0, 2 * at_T2_[WHEEL_PSI]);
}

Entry Swing::entry_at(const double* y0, double most_angle) const {
  const double growth = std::fmax(std::fabs(psi_growth_), std::fabs(phi_growth_));
  const double until = course_.ending ? course_.T2 : most_angle / (growth / course_.half_period());
  return {{y0[WHEEL_PSI], y0[WHEEL_PHI], place_of(y0), std::polar(1.0, y0[WHEEL_PSI])}, until};
}

// About a turning point T the motion is its own mirror image, with time reversed:
//   theta, omega_2, omega_3 at T + s are those at T - s, and omega_1 has the other sign;
//   psi(T + s) = 2 psi(T) - psi(T - s), and phi likewise;
//   O(T + s) - O(T) = -exp(2 i psi(T)) conj(O(T - s) - O(T)).
// The last holds because the velocity of O is exp(i psi) (a + i b), where a, along e1, is even about T as omega_3 is,
// and b, across it, is odd as omega_1 is.
//
// (k) => the half k. The k halves before it are the integrated one and its mirror image in turn. A pair of them turns
// the path by 2 delta and carries O by d + exp(2 i delta) conj(d) = 2 Re(d exp(-i delta)) exp(i delta), where d is the
// displacement of O in the first half. Another pi in delta changes none of it. n pairs carry O by a geometric sum,
// 2 Re(d exp(-i delta)) exp(i n delta) sin(n delta) / sin(delta). Where k is odd, one half more.
Half Swing::half_at(double k, const Pose& start) const {
  const double n = std::floor(0.5 * k);
  const bool mirrored = k != 2 * n;
  const Complex chord = std::polar(1.0, n * delta_), pairs_rotation = chord * chord;
  const double quotient = delta_ == 0 ? n : chord.imag() / std::sin(delta_);
  Complex way = pair_advance_ * quotient * chord;
  if (mirrored) way += displacement_ * pairs_rotation;
  Pose pose;
  pose.psi = start.psi + (mirrored ? 2 * at_T2_[WHEEL_PSI] + (k - 1) * psi_growth_ : k * psi_growth_);
  pose.phi = start.phi + (mirrored ? 2 * at_T2_[WHEEL_PHI] + (k - 1) * phi_growth_ : k * phi_growth_);
  pose.place = start.place + start.rotation * (place_of(at_T1_) + way * rotation_at_T1_);
  pose.rotation = start.rotation * (mirrored ? -pairs_rotation * mirror_rotation_ : pairs_rotation);
  return {begin_of(k), begin_of(k + 1), mirrored, pose};
}

const Half& Swing::half_of(const Entry& entry, double t) const {
  if (t >= entry.latest.begin && t < entry.latest.next) return entry.latest;
  double k = std::floor((t - course_.T1) / course_.half_period());
  if (t < begin_of(k)) k -= 1;
  if (t >= begin_of(k + 1)) k += 1;
  return entry.latest = half_at(k, entry.start);
}

void Swing::read(const Entry& entry, double t, double* y) const {
  const Track* const track = std::get_if<Track>(&course_.path);
  if (!track || t <= course_.T2) {
    course_.read(t, y);
    return entry.start.carry(place_of(y), y);
  }
  const Half& half = half_of(entry, t);
  const double since = std::clamp(t - half.begin, 0.0, course_.half_period());
  track->read(half.mirrored ? course_.T2 - since : course_.T1 + since, y);
  Complex way = place_of(y) - place_of(half.mirrored ? at_T2_ : at_T1_);
  if (half.mirrored) {
    way = std::conj(way);
    for (const int i : {WHEEL_OMEGA_1, WHEEL_PSI, WHEEL_PHI}) y[i] = -y[i];
  }
  half.pose.carry(way, y);
}

}  // namespace orbit
