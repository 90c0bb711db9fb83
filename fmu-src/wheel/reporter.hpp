// Where messages go, and how numbers are written in them.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace wheel {

// A number of a message that is written with so many digits; 0: as many as it needs.
struct Digits {
  double x;
  int digits = 0;
};

// A number as text; as many digits as it needs are the fewest of 15 to 17 that read back as the same double. It has a
// point whatever the host's locale is.
struct NumberText {
  explicit NumberText(Digits number) {
    int digits = number.digits > 0 ? number.digits : 15;
    // By the C library: std::to_chars would bring C++'s run-time library, with exceptions, into a release.
    do std::snprintf(text, sizeof text, "%.*g", digits, number.x);
    while (number.digits == 0 && std::strtod(text, nullptr) != number.x && ++digits <= 17);
    if (char* comma = std::strchr(text, ',')) *comma = '.';
  }
  char text[32];
};

enum class Topic { event, warning, error, discard };

struct Reporter {
  static constexpr int longest = 512;  // message, with the zero at its end

  const void* owner = nullptr;
  bool (*listens)(const void* owner, Topic topic) = nullptr;  // null: nobody does
  void (*take)(const void* owner, Topic topic, const char* message) = nullptr;

  // Printf-like, but a double and Digits are written as %s: times with all digits, so that a caller can go to exactly
  // that instant. Nothing is formatted where nobody listens.
  template <class... Parts>
  void log(Topic topic, const char* format, Parts... parts) const {
    if (listens && listens(owner, topic)) print(topic, format, plain(written(parts))...);
  }
  // Whether all is well; if not, the error is logged.
  template <class... Parts>
  bool check(bool sound, const char* format, Parts... parts) const {
    if (!sound) log(Topic::error, format, parts...);
    return sound;
  }

 private:
  static NumberText written(double x) { return NumberText(Digits{x}); }
  static NumberText written(Digits number) { return NumberText(number); }
  template <class Part>
  static Part written(Part part) {
    return part;
  }
  static const char* plain(const NumberText& number) { return number.text; }
  template <class Part>
  static Part plain(Part part) {
    return part;
  }
  void print(Topic topic, const char* format, ...) const;
};

}  // namespace wheel
