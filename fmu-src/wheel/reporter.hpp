// Where messages go, and how numbers are written in them.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace wheel {

// A number of a message that is written with so many digits.
struct Digits {
  double x;
  int digits;
};

// A number as text, with as many digits as it needs: the shortest of 15 to 17 that reads back as the same double; or as
// many as are asked for. It has a point whatever the host's locale is.
struct NumberText {
  explicit NumberText(double x) {
    int digits = 15;
    do write(x, digits);
    while (std::strtod(text, nullptr) != x && ++digits <= 17);
    point();
  }
  explicit NumberText(Digits number) {
    write(number.x, number.digits);
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
  static NumberText written(double x) { return NumberText(x); }
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
