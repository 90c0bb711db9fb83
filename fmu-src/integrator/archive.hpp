// Numbers to bytes and back: how snapshots are written, read and measured.
//
// Every number takes 8 bytes, a double or a 64-bit integer, whatever the platform's own integers are; little endian, as
// all platforms of this FMU are.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

namespace integrator {

struct Writer {
  unsigned char* at;
  void operator()(const double& x) { put(x); }
  template <class Integer>
  void operator()(const Integer& i) {
    put(static_cast<std::int64_t>(i));
  }
  template <class Word>
  void put(Word word) {
    std::memcpy(at, &word, sizeof word);
    at += sizeof word;
  }
};

struct Reader {
  const unsigned char* at;
  void operator()(double& x) { x = get<double>(); }
  template <class Integer>
  void operator()(Integer& i) {
    i = static_cast<Integer>(get<std::int64_t>());
  }
  template <class Word>
  Word get() {
    Word word;
    std::memcpy(&word, at, sizeof word);
    at += sizeof word;
    return word;
  }
};

struct Measure {
  std::size_t bytes = 0;
  template <class Number>
  void operator()(const Number&) {
    bytes += 8;
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

// n numbers in a row.
template <class Archive>
void many(Archive& archive, double* x, int n) {
  for (int i = 0; i < n; ++i) archive(x[i]);
}

template <class Archive, class... Fields>
void all(Archive& archive, Fields&... fields) {
  (archive(fields), ...);
}

}  // namespace integrator
