// Input polynomials: set at a communication point, in force from there on.
#include "inputs.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace wheel {
namespace {

constexpr double factorial[] = {1, 1, 2, 6};

double evaluate(const double* c, double tau) { return c[0] + tau * (c[1] + tau * (c[2] + tau * c[3])); }
double slope(const double* c, double tau) { return c[1] + tau * (2 * c[2] + tau * 3 * c[3]); }

// A brake cannot drive: where its polynomial falls below zero, the capacity counts as zero.
void limit_brake(WheelLoad& load) { load.brake = std::fmax(load.brake, 0); }

bool is_zero(const double* c) { return c[0] == 0 && c[1] == 0 && c[2] == 0 && c[3] == 0; }

// Real zeros of the slope c1 + 2 c2 x + 3 c3 x^2; returns their number.
int zeros_of_slope(const double* c, double* zeros) {
  const double a = 3 * c[3], half_b = c[2], d = half_b * half_b - a * c[1];
  if (a == 0) {
    if (half_b == 0) return 0;
    zeros[0] = -c[1] / (2 * half_b);
    return 1;
  }
  if (!(d > 0)) return 0;
  const double q = -(half_b + std::copysign(std::sqrt(d), half_b));
  zeros[0] = q / a;
  if (q == 0) return 1;
  zeros[1] = c[1] / q;
  return 2;
}

// Whether `next` is c seen from tau on.
bool continues(const double* c, double tau, double rounding, const double* next) {
  constexpr double relative = 64 * std::numeric_limits<double>::epsilon();
  const double shifted[] = {evaluate(c, tau), slope(c, tau), c[2] + 3 * tau * c[3], c[3], 0};
  const double size[] = {std::fabs(c[0]), std::fabs(c[1]), std::fabs(c[2]), std::fabs(c[3])}, length = std::fabs(tau);
  const double sums[] = {evaluate(size, length), slope(size, length), size[2] + 3 * length * size[3], size[3]};
  for (int k = 0; k <= Inputs::max_order; ++k)
    if (!(std::fabs(shifted[k] - next[k]) <= relative * sums[k] + rounding * (k + 1) * std::fabs(shifted[k + 1])))
      return false;
  return true;
}

}  // namespace

double* load_entry(WheelLoad& load, int input) {
  if (input < 3) return &load.F[input];
  return input < Inputs::brake ? &load.M[input - 3] : &load.brake;
}

bool Inputs::set_value(int input, double value) {
  if (pending[input][0] == value) return false;
  pending[input][0] = value;
  return true;
}

void Inputs::set_derivative(int input, int order, double derivative) {
  pending[input][order] = derivative / factorial[order];
}

void Inputs::hold_from(double t) {
  for (int i = 0; i < count; ++i) {
    std::fill(pending[i] + 1, pending[i] + max_order + 1, 0.0);
    pending[i][0] = evaluate(in_force[i], t - origin);
  }
  pending[brake][0] = std::fmax(pending[brake][0], 0);  // like any brake that is set
}

bool Inputs::change_at(double t, double rounding) const {
  const double tau = varies ? t - origin : 0;
  for (int i = 0; i < count; ++i)
    if (!continues(in_force[i], tau, rounding, pending[i])) return true;
  return false;
}

void Inputs::take_over(double t) {
  std::memcpy(in_force, pending, sizeof in_force);
  origin = t;
  classify();
}

void Inputs::classify() {
  loaded = varies = false;
  for (const auto& c : in_force) {
    loaded = loaded || !is_zero(c);
    varies = varies || c[1] != 0 || c[2] != 0 || c[3] != 0;
  }
  braked = !is_zero(in_force[brake]);
}

void Inputs::load_at(double t, WheelLoad* load) const {
  for (int i = 0; i < count; ++i) *load_entry(*load, i) = evaluate(in_force[i], t - origin);
  limit_brake(*load);
}

void Inputs::pending_load(WheelLoad* load) const {
  for (int i = 0; i < count; ++i) *load_entry(*load, i) = pending[i][0];
  limit_brake(*load);
}

WheelLoad Inputs::pending_rate() const {
  WheelLoad rate = {};
  for (int i = 0; i < count; ++i) *load_entry(rate, i) = pending[i][1];
  return rate;
}

bool Inputs::pending_brake() const { return !is_zero(pending[brake]); }

int Inputs::extremes(double t_lo, double t_hi, double* instants) const {
  if (!varies) return 0;
  int found = 0;
  for (const auto& c : in_force) {
    double zeros[2];
    for (int k = zeros_of_slope(c, zeros); k > 0; --k) {
      const double t = origin + zeros[k - 1];
      if (t > t_lo && t < t_hi) instants[found++] = t;
    }
  }
  std::sort(instants, instants + found);
  return found;
}

}  // namespace wheel
