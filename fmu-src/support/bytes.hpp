// Numbers to bytes and back: how snapshots are written, read and measured.
//
// Every number takes 8 bytes, a double or a 64-bit integer, whatever the platform's own integers are; little endian, as
// all platforms of this FMU are. Bytes to be read may come from anywhere: a Reader never leaves them, and says
// afterwards whether each was one that a Writer could have written.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

namespace support {

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
  std::size_t left;  // bytes from `at` on
  bool sound = true;

  // Any double; who needs a finite one, or a limit, asks for it with `require`.
  void operator()(double& x) { x = get<double>(); }
  void operator()(bool& truth) { truth = whole(0, 1) != 0; }
  template <class Integer>
  void operator()(Integer& i) {
    using limits = std::numeric_limits<Integer>;
    static_assert(limits::is_integer && sizeof(Integer) <= 8);
    if constexpr (limits::is_signed || sizeof(Integer) < 8)
      i = static_cast<Integer>(whole(std::int64_t{limits::min()}, std::int64_t{limits::max()}));
    else
      i = static_cast<Integer>(get<std::int64_t>());
  }
  void require(bool truth) { sound = sound && truth; }

  // An integer from low to high, low where the bytes hold none.
  std::int64_t whole(std::int64_t low, std::int64_t high) {
    const auto i = get<std::int64_t>();
    require(i >= low && i <= high);
    return i >= low && i <= high ? i : low;
  }
  template <class Word>
  Word get() {
    Word word = {};
    require(left >= sizeof word);
    if (!sound) return word;
    std::memcpy(&word, at, sizeof word);
    at += sizeof word;
    left -= sizeof word;
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

// An enumeration whose values are `first` to `last`, each an integer.
template <class Archive, class Enum>
void choice(Archive& archive, Enum& value, Enum first, Enum last) {
  archive(static_cast<std::int64_t>(value)), static_cast<void>(first), static_cast<void>(last);
}
template <class Enum>
void choice(Reader& reader, Enum& value, Enum first, Enum last) {
  value = static_cast<Enum>(reader.whole(static_cast<std::int64_t>(first), static_cast<std::int64_t>(last)));
}

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

// n numbers in a row.
template <class Archive>
void many(Archive& archive, double* x, int n) {
  for (int i = 0; i < n; ++i) archive(x[i]);
}

template <class Archive, class... Fields>
void all(Archive& archive, Fields&... fields) {
  (archive(fields), ...);
}

}  // namespace support
