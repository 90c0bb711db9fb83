// Numbers to bytes and back: how histories are written, read and measured.
//
// Every number takes 8 bytes, a double or a 64-bit integer; little endian, as all platforms of this FMU are. A reader
// checks each number before it is used: `good` says whether all of them could have been written.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

namespace solver {

// A visitor's names for what a field may be; each comes down to put(double or integer, greatest and least value).
template <class Derived>
struct Archive {
  static constexpr double greatest = std::numeric_limits<double>::max();

  void range(double& x, double least, double most) { self().put(x, least, most); }
  void number(double& x) { self().put(x, -greatest, greatest); }
  void numbers(double* x, int n) {
    for (int i = 0; i < n; ++i) number(x[i]);
  }
  template <class Integer>
  void count(Integer& i, long long least, long long most) {
    std::int64_t word = static_cast<std::int64_t>(i);
    self().put(word, least, most);
    i = static_cast<Integer>(word);
  }

 private:
  Derived& self() { return static_cast<Derived&>(*this); }
};

struct Writer : Archive<Writer> {
  unsigned char* at;
  explicit Writer(unsigned char* bytes) : at(bytes) {}
  template <class Word, class Bound>
  void put(Word& word, Bound, Bound) {
    static_assert(sizeof word == 8);
    std::memcpy(at, &word, sizeof word);
    at += sizeof word;
  }
};

struct Reader : Archive<Reader> {
  const unsigned char *at, *end;
  bool good = true;
  Reader(const unsigned char* bytes, std::size_t size) : at(bytes), end(bytes + size) {}
  // A word outside its bounds, or beyond the end, leaves the least value allowed: what is read on is harmless.
  template <class Word, class Bound>
  void put(Word& word, Bound least, Bound most) {
    word = static_cast<Word>(least);
    if (end - at < 8) return void(good = false);
    Word read;
    std::memcpy(&read, at, sizeof read);
    at += sizeof read;
    if (read >= static_cast<Word>(least) && read <= static_cast<Word>(most))
      word = read;
    else
      good = false;
  }
};

struct Measure : Archive<Measure> {
  std::size_t bytes = 0;
  template <class Word, class Bound>
  void put(Word&, Bound, Bound) {
    bytes += 8;
  }
};

}  // namespace solver
