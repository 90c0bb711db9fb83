// Numbers to bytes and back: how snapshots are written, read and measured.
//
// Every number takes 8 bytes, a double or a 64-bit integer, whatever the platform's own integers are; little endian, as
// all platforms of this FMU are. Bytes to be read may come from anywhere: a Reader never leaves them, checks each
// number against what it may be, and says afterwards whether all of them could have been written.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

namespace support {

// What a field may be; each name comes down to put(word, least, most) of a Writer, a Reader or a Measure.
template <class Derived>
struct Archive {
  static constexpr double greatest = std::numeric_limits<double>::max();
  const char* row = "";  // what is read or written now, in words

  Derived& operator()(const char* what) { return row = what, self(); }
  void range(double& x, double least, double most) { self().put(x, least, most); }
  void number(double& x) { range(x, -greatest, greatest); }  // finite
  void numbers(double* x, int n) {
    for (int i = 0; i < n; ++i) number(x[i]);
  }
  template <class Integer>
  void count(Integer& i, long long least, long long most) {
    auto word = static_cast<std::int64_t>(i);
    self().put(word, static_cast<std::int64_t>(least), static_cast<std::int64_t>(most));
    i = static_cast<Integer>(word);
  }
  // A count stays at the largest that is saved: what goes on counting can be saved again.
  void tally(long long& n) {
    constexpr long long most = 9007199254740992;
    n = n < most ? n : most;
    count(n, 0, most);
  }
  // Any double at all, as a caller may have set it.
  void anything(double& x) {
    std::int64_t word;
    std::memcpy(&word, &x, sizeof word);
    count(word, std::numeric_limits<std::int64_t>::min(), std::numeric_limits<std::int64_t>::max());
    std::memcpy(&x, &word, sizeof x);
  }

 private:
  Archive() = default;
  friend Derived;
  Derived& self() { return static_cast<Derived&>(*this); }
};

struct Writer : Archive<Writer> {
  unsigned char* at;
  explicit Writer(unsigned char* bytes) : at(bytes) {}
  template <class Word>
  void put(Word& word, Word, Word) {
    std::memcpy(at, &word, sizeof word);
    at += sizeof word;
  }
};

struct Reader : Archive<Reader> {
  const unsigned char *at, *end;
  const char* fault = nullptr;  // the first row that could not have been written
  Reader(const unsigned char* bytes, std::size_t size) : at(bytes), end(bytes + size) {}
  // A word outside its bounds, or beyond the end, gives the least allowed value, so that reading on is harmless.
  template <class Word>
  void put(Word& word, Word least, Word most) {
    Word read = least;
    const bool complete = end - at >= 8;
    if (complete) std::memcpy(&read, at, sizeof read);
    if (complete) at += sizeof read;
    const bool sound = complete && read >= least && read <= most;
    if (!sound && !fault) fault = row;
    word = sound ? read : least;
  }
};

struct Measure : Archive<Measure> {
  std::size_t bytes = 0;
  template <class Word>
  void put(Word&, Word, Word) {
    bytes += sizeof(Word);
  }
};

// FNV-1a over words of 64 bits; a snapshot is a whole number of them. A change of any one word changes the sum.
inline std::uint64_t checksum_of(const unsigned char* bytes, std::size_t size) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (std::size_t i = 0; i < size; i += 8) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes + i, size - i < 8 ? size - i : 8);
    hash = (hash ^ word) * 0x100000001b3u;
    hash ^= hash >> 29u;
  }
  return hash;
}

// Guards against accidents. A build with WHEEL_UNCHECKED_STATES, for the fuzzer of forged states, takes every sum as
// right: what then keeps the instance safe are the checks of the numbers themselves.
inline bool has_checksum(const unsigned char* bytes, std::size_t size, std::uint64_t sum) {
#ifdef WHEEL_UNCHECKED_STATES
  return static_cast<void>(bytes), static_cast<void>(size), static_cast<void>(sum), true;
#else
  return checksum_of(bytes, size) == sum;
#endif
}

}  // namespace support
