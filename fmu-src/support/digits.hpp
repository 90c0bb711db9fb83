// A number for a message with as many digits as it needs: the shortest of 15 to 17 that reads back as the same double,
// with a point whatever the host's locale is. Times are given in this way, so that a master can be told exactly when
// something was.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace support {

struct Digits {
  // By the C library: std::to_chars would bring C++'s run-time library, with exceptions, into a release.
  explicit Digits(double x) {
    for (int digits = 15; digits <= 17; ++digits) {
      std::snprintf(text, sizeof text, "%.*g", digits, x);
      if (std::strtod(text, nullptr) == x) break;
    }
    if (char* comma = std::strchr(text, ',')) *comma = '.';
  }
  char text[32];
};

}  // namespace support
