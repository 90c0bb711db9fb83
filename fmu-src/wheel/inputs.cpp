// Input polynomials: set at a communication point, in force from there on.
#include "inputs.hpp"

#include <algorithm>
#include <cstring>

namespace wheel {
namespace {

constexpr double factorial[] = {1, 1, 2, 6};

double* entry(WheelLoad& load, int input) { return input < 3 ? &load.F[input] : &load.M[input - 3]; }

}  // namespace

void Inputs::set_value(int input, double value) { pending_[input][0] = value; }

void Inputs::set_derivative(int input, int order, double derivative) {
  pending_[input][order] = derivative / factorial[order];
}

double Inputs::evaluate(const double* c, double tau) { return c[0] + tau * (c[1] + tau * (c[2] + tau * c[3])); }

void Inputs::hold_from(double t) {
  for (int i = 0; i < count; ++i) {
    std::fill(pending_[i] + 1, pending_[i] + max_order + 1, 0.0);
    pending_[i][0] = evaluate(current_[i], t - origin_);
  }
}

bool Inputs::differ_from_current(double t) const {
  double shifted[max_order + 1];
  for (int i = 0; i < count; ++i) {
    const double *c = current_[i], tau = varies_ ? t - origin_ : 0;
    shifted[0] = evaluate(c, tau);
    shifted[1] = c[1] + tau * (2 * c[2] + tau * 3 * c[3]);
    shifted[2] = c[2] + 3 * tau * c[3];
    shifted[3] = c[3];
    if (!std::equal(shifted, shifted + max_order + 1, pending_[i])) return true;
  }
  return false;
}

void Inputs::take_over(double t) {
  std::memcpy(current_, pending_, sizeof current_);
  origin_ = t;
  loaded_ = varies_ = false;
  for (const auto& c : current_) {
    loaded_ = loaded_ || c[0] != 0 || c[1] != 0 || c[2] != 0 || c[3] != 0;
    varies_ = varies_ || c[1] != 0 || c[2] != 0 || c[3] != 0;
  }
}

void Inputs::load_at(double t, WheelScene* scene) const {
  scene->loaded = loaded_;
  for (int i = 0; loaded_ && i < count; ++i) *entry(scene->load, i) = evaluate(current_[i], t - origin_);
}

WheelLoad Inputs::rate_at(double t) const {
  WheelLoad rate = {};
  const double tau = t - origin_;
  for (int i = 0; varies_ && i < count; ++i) {
    const double* c = current_[i];
    *entry(rate, i) = c[1] + tau * (2 * c[2] + tau * 3 * c[3]);
  }
  return rate;
}

void Inputs::pending_load(WheelScene* scene) const {
  scene->loaded = 0;
  for (int i = 0; i < count; ++i) {
    *entry(scene->load, i) = pending_[i][0];
    if (pending_[i][0] != 0) scene->loaded = 1;
  }
}

WheelLoad Inputs::pending_rate() const {
  WheelLoad rate = {};
  for (int i = 0; i < count; ++i) *entry(rate, i) = pending_[i][1];
  return rate;
}

}  // namespace wheel
