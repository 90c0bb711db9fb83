// A number for a message with as many digits as it needs: the shortest that reads back as the same double, with a point
// whatever the host's locale is. Times are given in this way, so that a master can be told exactly when something was.
#pragma once

#include <charconv>
#include <cmath>

namespace support {

struct Digits {
  explicit Digits(double x) {
    // Plain decimals for ordinary sizes, an exponent, as in 1e+300, for all others.
    const double size = std::fabs(x);
    const bool plain = size == 0 || (size >= 1e-5 && size < 1e15);
    const auto format = plain ? std::chars_format::fixed : std::chars_format::general;
    *std::to_chars(text, text + sizeof text - 1, x, format).ptr = 0;
  }
  char text[32];
};

}  // namespace support
