// Numbers to bytes and back: how snapshots are written, read and measured.
//
// Every number takes 8 bytes, a double or a 64-bit integer, whatever the platform's integers are; little endian, as
// all platforms of this FMU are. Bytes to be read may come from anywhere: reading never leaves them, and each number
// stays within its bounds.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

namespace support {

// What is done with each field that is shown to it: its bytes are counted, written, or read and checked.
class Archive {
 public:
  static constexpr double greatest = std::numeric_limits<double>::max();

  static Archive counting() { return {nullptr, nullptr, 0}; }
  static Archive writing(unsigned char* to) { return {to, nullptr, 0}; }
  static Archive reading(const unsigned char* from, std::size_t size) { return {nullptr, from, size}; }

  bool reads() const { return from_ != nullptr; }
  std::size_t bytes() const { return bytes_; }  // of the fields so far
  bool fits() const { return fits_; }           // so far each number lies within its bounds
  void refuse() { fits_ = false; }
  bool is_sound() const { return fits_ && bytes_ == size_; }  // and no byte is left

  void range(double& x, double least, double most) { put(x, least, most); }
  template <class... Doubles>
  void number(Doubles&... x) {  // finite
    (range(x, -greatest, greatest), ...);
  }
  void numbers(double* x, int n) {
    for (int i = 0; i < n; ++i) number(x[i]);
  }
  template <class Integer>
  void count(Integer& i, long long least, long long most) {
    auto word = static_cast<std::int64_t>(i);
    put(word, static_cast<std::int64_t>(least), static_cast<std::int64_t>(most));
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
    auto word = std::bit_cast<std::int64_t>(x);
    count(word, std::numeric_limits<std::int64_t>::min(), std::numeric_limits<std::int64_t>::max());
    x = std::bit_cast<double>(word);
  }

 private:
  Archive(unsigned char* to, const unsigned char* from, std::size_t size) : to_(to), from_(from), size_(size) {}

  // A word outside its bounds, or beyond the end, is read as the least allowed value, so that reading on is harmless.
  template <class Word>
  void put(Word& word, Word least, Word most) {
    const std::size_t at = bytes_;
    bytes_ += sizeof word;
    if (to_) std::memcpy(to_ + at, &word, sizeof word);
    if (!from_) return;
    Word read = least;
    const bool complete = bytes_ <= size_;
    if (complete) std::memcpy(&read, from_ + at, sizeof read);
    const bool sound = complete && read >= least && read <= most;
    fits_ &= sound;
    word = sound ? read : least;
  }

  unsigned char* to_;
  const unsigned char* from_;
  std::size_t size_, bytes_ = 0;
  bool fits_ = true;
};

// Each word of 64 bits is multiplied in and mixed by a shift; a snapshot is a whole number of words. A change of any
// one word changes the sum. It guards against accidents, not against forgery.
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

}  // namespace support
