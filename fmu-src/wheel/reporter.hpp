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
class NumberText {
 public:
  const char* of(Digits number) {
    int digits = number.digits > 0 ? number.digits : 15;
    // By the C library: std::to_chars would bring C++'s run-time library, with exceptions, into a release.
    do std::snprintf(text_, sizeof text_, "%.*g", digits, number.x);
    while (number.digits == 0 && std::strtod(text_, nullptr) != number.x && ++digits <= 17);
    char* const mark = text_ + std::strspn(text_, "+-0123456789");  // of one or more bytes, if there is one
    const std::size_t length = std::strcspn(mark, "+-0123456789einfa");
    if (length == 0) return text_;
    *mark = '.';
    std::memmove(mark + 1, mark + length, std::strlen(mark + length) + 1);
    return text_;
  }

 private:
  char text_[32];
};

enum class Topic { event, warning, error, discard };

// Takes the messages of a wheel. This one drops them.
struct Reporter {
  static constexpr int longest = 512;  // message, with the zero at its end

  Reporter() = default;
  Reporter(const Reporter&) = delete;  // a copy would drop them

  virtual bool listens(Topic) const { return false; }
  virtual void take(Topic, const char*) const {}

  // Printf-like, but a double and Digits are written as %s, a double with all digits: a caller can go to exactly that
  // instant. Nothing is formatted where nobody listens.
  template <class... Parts>
  void log(Topic topic, const char* format, Parts... parts) const {
    if (!listens(topic)) return;
    char message[longest];
    std::snprintf(message, sizeof message, format, plain(parts)..., "");  // no format reads the last part
    take(topic, message);
  }
  // Whether all is well; if not, the error is logged.
  template <class... Parts>
  bool check(bool sound, const char* format, Parts... parts) const {
    if (!sound) log(Topic::error, format, parts...);
    return sound;
  }

 private:
  // The text lives as long as the call that prints it.
  static const char* plain(Digits number, NumberText&& text = {}) { return text.of(number); }
  static const char* plain(double x, NumberText&& text = {}) { return text.of({x}); }
  template <class Part>
  static Part plain(Part part) {
    return part;
  }
};

}  // namespace wheel
