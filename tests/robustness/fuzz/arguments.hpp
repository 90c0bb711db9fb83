// Arguments of one call, drawn by their types: arrays of a few variables and as many values, or rarely no array at all.
#pragma once

#include <fuzzer/FuzzedDataProvider.h>

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <list>
#include <tuple>
#include <type_traits>
#include <vector>

#include "oracle.hpp"

namespace fuzz {

// The fuzzer's bytes read as choices and numbers. When they run out every choice is 0 and every number 0.
class Bytes : public FuzzedDataProvider {
 public:
  using FuzzedDataProvider::FuzzedDataProvider;
  bool empty() { return remaining_bytes() == 0; }
  unsigned byte() { return ConsumeIntegral<std::uint8_t>(); }
  unsigned word() { return ConsumeIntegral<std::uint16_t>(); }
  unsigned below(unsigned n) { return ConsumeIntegralInRange(0u, n - 1); }
  int signed_byte() { return static_cast<int>(byte()) - 128; }
  // True in `sixteenths` of 16 cases.
  bool chance(unsigned sixteenths) { return below(16) < sixteenths; }

  // One byte: a factor between 2^-4 and 2^4 around 1.
  double factor() { return std::exp2(signed_byte() / 32.0); }

  // An array as an argument: rarely it is missing.
  template <class T>
  T* array(std::vector<T>& values) {
    return chance(1) ? nullptr : values.data();
  }

  // Any double: a limit of the format, a decimal of ordinary size, or eight raw bytes.
  double any() {
    using Limits = std::numeric_limits<double>;
    constexpr double infinite = Limits::infinity(), nan = Limits::quiet_NaN(), pi = 3.141592653589793;
    constexpr double most = Limits::max(), least = Limits::denorm_min();
    constexpr double limits[] = {0, -0.0, 1, -1, 1e-300, 1e300, pi / 2, pi, infinite, -infinite, nan, most, least};
    const unsigned kind = byte();
    if (kind < 32) return limits[kind % (sizeof limits / sizeof *limits)];
    if (kind < 224) return signed_byte() * std::pow(10.0, static_cast<int>(kind % 9) - 5);
    return std::bit_cast<double>(ConsumeIntegral<std::uint64_t>());
  }
};

// A value of ordinary or extreme size for a variable: sizes that matter are the start values of the parameters as
// modelDescription.xml has them, and what moves a wheel.
inline double value_for(unsigned reference, Bytes& in) {
  const Row* const row = row_of(reference);
  const bool loads = row && row->role == Role::input;
  if (!row || row->role > Role::input || in.chance(2)) {
    // Extreme loads are limited: CVODE would honestly follow them through the million steps that a call may take.
    const double value = in.any();
    return loads && std::isfinite(value) ? std::remainder(value, 1e4) : value;
  }
  if (in.chance(2)) return 0;
  const double size = loads ? 10 : row->start == 0 ? 0.1 : row->start;
  const double value = size * in.factor();
  return in.chance(4) ? -value : value;
}

class Arguments {
 public:
  explicit Arguments(Bytes& in) : in_(in), count_(in.chance(8) ? 1 : in.below(most + 1)) {}

  template <class T>
  T draw() {
    if constexpr (std::is_same_v<T, fmi2StatusKind>) return static_cast<T>(in_.below(4));
    if constexpr (std::is_same_v<T, std::size_t>) return count_;
    if constexpr (std::is_pointer_v<T>) {
      using Entry = std::remove_pointer_t<T>;
      auto& array = std::get<Arrays<std::remove_const_t<Entry>>>(arrays_).emplace_back(most);
      if constexpr (std::is_const_v<Entry>) fill(array);
      return in_.chance(1) ? nullptr : array.data();
    }
  }
  // Those drawn or received last.
  const std::vector<double>& reals() const { return std::get<Arrays<double>>(arrays_).back(); }

 private:
  static constexpr unsigned most = 4;
  template <class Entry>
  using Arrays = std::list<std::vector<Entry>>;

  void fill(std::vector<unsigned>& references) {
    constexpr unsigned choices[] = {ref_formulation, ref_friction_law, ref_method, ref_keep_contact};
    const unsigned kind = in_.below(4);
    for (std::size_t k = 0; k < count_; ++k) {
      const unsigned choice = in_.byte();
      references[k] = kind == 3   ? choices[choice % 4]
                      : kind == 0 ? rows[choice % std::size(rows)].reference
                                  : any_of(kind == 1 ? Role::input : Role::output, choice);
      if (choice >= 250) references[k] = choice * 0x01010101u;
      trace("  variable %u\n", references[k]);
    }
  }
  void fill(std::vector<double>& values) {
    for (std::size_t k = 0; k < count_; ++k) {
      values[k] = value_for(std::get<Arrays<unsigned>>(arrays_).back()[k], in_);
      trace("  %.17g\n", values[k]);
    }
  }
  void fill(std::vector<int>& values) {
    for (std::size_t k = 0; k < count_; ++k) {
      values[k] = static_cast<int>(in_.chance(14) ? in_.below(5) : in_.byte() * 0x01010101u);
      trace("  %d\n", values[k]);
    }
  }
  void fill(std::vector<fmi2String>& texts) { texts.assign(most, ""); }

  Bytes& in_;
  std::size_t count_;
  std::tuple<Arrays<unsigned>, Arrays<double>, Arrays<int>, Arrays<fmi2String>, Arrays<fmi2Status>> arrays_;
};

}  // namespace fuzz
