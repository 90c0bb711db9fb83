// Arguments of one call, drawn by their types: arrays of a few variables and as many values, or rarely no array at all.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <list>
#include <tuple>
#include <type_traits>
#include <vector>

#include "oracle.hpp"

namespace fuzz {

// The fuzzer's bytes read as choices and numbers. When they run out every choice is 0 and every number 0.
class Bytes {
 public:
  Bytes(const std::uint8_t* data, std::size_t size) : at_(data), end_(data + size) {}

  bool empty() const { return at_ == end_; }
  unsigned byte() { return empty() ? 0 : *at_++; }
  unsigned below(unsigned n) { return byte() % n; }
  unsigned word() {
    const unsigned high = byte();
    return high << 8 | byte();
  }
  int signed_byte() { return static_cast<int>(byte()) - 128; }
  // True in `sixteenths` of 16 cases.
  bool chance(unsigned sixteenths) { return byte() % 16 < sixteenths; }

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
    std::uint64_t raw = 0;
    for (int i = 0; i < 8; ++i) raw = raw << 8 | byte();
    double number;
    std::memcpy(&number, &raw, sizeof number);
    return number;
  }

 private:
  const std::uint8_t* at_;
  const std::uint8_t* end_;
};

// A value of ordinary or extreme size for a variable.
double value_for(unsigned reference, Bytes& in);

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

  void fill(std::vector<unsigned>& references);
  void fill(std::vector<double>& values);
  void fill(std::vector<int>& values);
  void fill(std::vector<fmi2String>& texts) { texts.assign(most, ""); }

  Bytes& in_;
  std::size_t count_;
  std::tuple<Arrays<unsigned>, Arrays<double>, Arrays<int>, Arrays<fmi2String>, Arrays<fmi2Status>> arrays_;
};

}  // namespace fuzz
