// A number for a message: as many digits as it needs, the shortest of 15 to 17 that reads back as the same double, or
// as many as are asked for; with a point whatever the host's locale is. All numbers of messages that are not whole are
// written by it. Times are given with all digits, so that a caller can go to exactly that instant.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace support {

struct Digits {
  explicit Digits(double x) {
    int digits = 15;
    do write(x, digits);
    while (std::strtod(text, nullptr) != x && ++digits <= 17);
    point();
  }
  Digits(double x, int digits) {
    write(x, digits);
    point();
  }
  char text[32];

 private:
  // By the C library: std::to_chars would bring C++'s run-time library, with exceptions, into a release.
  void write(double x, int digits) { std::snprintf(text, sizeof text, "%.*g", digits, x); }
  void point() {
    if (char* comma = std::strchr(text, ',')) *comma = '.';
  }
};

}  // namespace support
