// Arguments of one call, drawn by their types: arrays of a few variables and as many values, or rarely no array at all.
#pragma once

#include <list>
#include <tuple>
#include <type_traits>

#include "choices.hpp"
#include "oracle.hpp"

namespace fuzz {

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
