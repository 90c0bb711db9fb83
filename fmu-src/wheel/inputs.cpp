// Values, rates, extremes and changes of input polynomials.
#include "inputs.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include "constant.hpp"

namespace wheel {
namespace {

double value_at(const double* c, double tau) { return c[0] + tau * (c[1] + tau * (c[2] + tau * c[3])); }
double rate_at(const double* c, double tau) { return c[1] + tau * (2 * c[2] + tau * 3 * c[3]); }

// Whether a coefficient is not zero.
bool acts(const double* c) {
  return std::any_of(c, c + max_order + 1, [](double part) { return part != 0; });
}

// (c) => real zeros of the slope c1 + 2 c2 x + 3 c3 x^2, of which one is infinite where c3 is zero; returns their
// number
int zeros_of_slope(const double* c, double* zeros) {
  const double a = 3 * c[3], half_b = c[2], d = half_b * half_b - a * c[1];
  if (!std::isfinite(d)) {  // an overflow: coefficients are finite
    const double less[] = {0, 0x1p-600 * c[1], 0x1p-600 * c[2], 0x1p-600 * c[3]};
    return zeros_of_slope(less, zeros);
  }
  if (!(d > 0)) return 0;
  const double q = -(half_b + std::copysign(std::sqrt(d), half_b));
  zeros[0] = q / a;
  zeros[1] = c[1] / q;
  return 2;
}

// Whether `next` is c seen from tau on.
bool continues(const double* c, double tau, double rounding, const double* next) {
  CONSTANT(double, relative, 64 * std::numeric_limits<double>::epsilon(), "1", "of a polynomial cut into steps");
  const double shifted[] = {value_at(c, tau), rate_at(c, tau), c[2] + 3 * tau * c[3], c[3], 0};
  const double size[] = {std::fabs(c[0]), std::fabs(c[1]), std::fabs(c[2]), std::fabs(c[3])}, length = std::fabs(tau);
  const double sums[] = {value_at(size, length), rate_at(size, length), size[2] + 3 * length * size[3], size[3]};
  for (int k = 0; k <= max_order; ++k)
    if (!(std::fabs(shifted[k] - next[k]) <= relative * sums[k] + rounding * (k + 1) * std::fabs(shifted[k + 1])))
      return false;
  return true;
}

}  // namespace

Span span_of(const double (&c)[max_order + 1], double tau) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  double zeros[2];
  Span span = {c[0], c[0]};
  const auto take = [&](double value) {
    span = std::isfinite(value) ? Span{std::fmin(span.least, value), std::fmax(span.largest, value)}
                                : Span{-infinite, infinite};
  };
  for (int k = zeros_of_slope(c, zeros); k > 0; --k)
    if (zeros[k - 1] > 0 && zeros[k - 1] < tau) take(value_at(c, zeros[k - 1]));
  take(value_at(c, tau));
  return span;
}

// Each step asks for it, so it tests bits without a branch. The sign does not count: -0 is zero.
bool varies(const Polynomials& inputs) {
  std::uint64_t bits = 0;
  for (const auto& c : inputs)
    for (int k = 1; k <= max_order; ++k) bits |= std::bit_cast<std::uint64_t>(c[k]);
  return bits << 1U != 0;
}

bool has_derivatives(const double (&c)[max_order + 1]) { return c[1] != 0 || c[2] != 0 || c[3] != 0; }

bool is_guiding(const Polynomials& inputs) { return acts(inputs[guide_input]) || acts(inputs[guide_input + 1]); }

double* load_entry(WheelLoad& load, int input) {
  if (input < 3) return &load.F[input];
  if (input < brake_input) return &load.M[input - 3];
  return input == brake_input ? &load.brake : &load.guide[input - guide_input];
}

// A brake cannot drive: where its polynomial falls below zero, the capacity counts as zero.
// Out of line: most scenes do not need it, and their loop of evaluations is smaller.
[[gnu::noinline]] void Inputs::set_load_at(double t, WheelLoad& load) const {
  const double tau = t - origin;
  for (int i = 0; i < guide_input; ++i) *load_entry(load, i) = value_at(c[i], tau);
  for (int i = 0; i < 2; ++i) load.guide[i] = guides ? rate_at(c[guide_input + i], tau) : 0;
  if (!(load.brake > 0)) load.brake = 0;
}

WheelLoad Inputs::load_rate_at(double t) const {
  const double tau = t - origin;
  WheelLoad rate = {};
  for (int i = 0; i < guide_input; ++i) *load_entry(rate, i) = rate_at(c[i], tau);
  for (int i = guide_input; i < inputs_count; ++i) *load_entry(rate, i) = 2 * c[i][2] + tau * 6 * c[i][3];
  const double asked = value_at(c[brake_input], tau);
  if (asked <= 0) rate.brake = asked < 0 ? 0 : std::fmax(rate.brake, 0);
  return rate;
}

void Inputs::take_over(double t, const Polynomials& asked) {
  origin = t;
  std::memcpy(c, asked, sizeof c);
  varies = wheel::varies(c);
  guides = is_guiding(c);
  loaded = std::any_of(c, c + inputs_count, acts);
  braked = acts(c[brake_input]);
}

bool Inputs::change_at(double t, double rounding, const Polynomials& asked) const {
  const double tau = varies ? t - origin : 0;
  for (int i = 0; i < inputs_count; ++i)
    if (!continues(c[i], tau, rounding, asked[i])) return true;
  return false;
}

double Inputs::value_of(int input, double t) const {
  const double value = value_at(c[input], t - origin);
  return input == brake_input ? std::fmax(value, 0) : value;
}

int Inputs::extremes(double t_lo, double t_hi, double* instants) const {
  int found = 0;
  const auto take = [&](double tau) {
    const double t = origin + tau;
    if (t > t_lo && t < t_hi) instants[found++] = t;
  };
  for (const auto& polynomial : c) {
    double zeros[2];
    for (int k = zeros_of_slope(polynomial, zeros); k > 0; --k) take(zeros[k - 1]);
  }
  for (int i = guide_input; i < inputs_count; ++i) take(-c[i][2] / (3 * c[i][3]));  // of its slope
  std::sort(instants, instants + found);
  return found;
}

// Between two extremes the polynomial passes zero at most once. Halves until no time lies between the ends.
double Inputs::corner(double t, double until) const {
  const auto brakes = [&](double at) { return value_at(c[brake_input], at - origin) > 0; };
  double ends[most_extremes + 1];
  int pieces = extremes(t, until, ends);
  ends[pieces++] = until;
  for (int i = 0; i < pieces; ++i) {
    double lo = t, hi = ends[i];
    t = ends[i];
    if (brakes(lo) == brakes(hi)) continue;
    for (;;) {
      const double middle = lo + 0.5 * (hi - lo);
      if (!(lo < middle && middle < hi)) return hi;
      (brakes(middle) == brakes(lo) ? lo : hi) = middle;
    }
  }
  return std::numeric_limits<double>::infinity();
}

}  // namespace wheel
