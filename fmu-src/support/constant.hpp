// A number that was chosen, with its unit and its reason. From these lines ./scripts/constants makes the table of
// docs/constants.md, and it measures the consequence of half and double: a build with WHEEL_CONSTANTS multiplies the
// constant that the environment names (WHEEL_CONSTANT=file.name) by WHEEL_FACTOR.
#pragma once

#ifdef WHEEL_CONSTANTS
#include <cstdlib>
#include <string>
#include <string_view>

namespace support {
inline double changed(const char* file, const char* name, double value) {
  const char *chosen = std::getenv("WHEEL_CONSTANT"), *factor = std::getenv("WHEEL_FACTOR");
  const std::string_view path = file, base = path.substr(path.rfind('/') + 1);
  const std::string whole = std::string(base.substr(0, base.find('.'))) + "." + name;
  return chosen && factor && whole == chosen ? value * std::strtod(factor, nullptr) : value;
}
}  // namespace support

#define CONSTANT(type, name, value, unit, reason) \
  [[maybe_unused]] static const type name = static_cast<type>(support::changed(__FILE__, #name, value))
#else
#define CONSTANT(type, name, value, unit, reason) constexpr type name = value
#endif
