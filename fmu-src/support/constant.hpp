// A number that was chosen, with its unit and its reason. From these lines ./scripts/constants makes the table of
// docs/constants.md, and it measures the consequence of half and double: a build with WHEEL_CONSTANTS multiplies the
// constant that the environment names (WHEEL_CONSTANT=file.name) by WHEEL_FACTOR.
#pragma once

#ifdef WHEEL_CONSTANTS
#include <cstdlib>
#include <cstring>
#include <string>

namespace support {
inline double changed(const char* file, const char* name, double value) {
  const char *chosen = std::getenv("WHEEL_CONSTANT"), *factor = std::getenv("WHEEL_FACTOR");
  if (!chosen || !factor) return value;
  std::string stem = std::strrchr(file, '/') ? std::strrchr(file, '/') + 1 : file;
  stem.resize(stem.find('.'));
  return stem + "." + name == chosen ? value * std::strtod(factor, nullptr) : value;
}
}  // namespace support

#define CONSTANT(type, name, value, unit, reason) \
  [[maybe_unused]] static const type name = static_cast<type>(support::changed(__FILE__, #name, value))
#else
#define CONSTANT(type, name, value, unit, reason) constexpr type name = value
#endif
