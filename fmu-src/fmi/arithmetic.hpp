// The host's floating-point environment: it may trap exceptions, round otherwise than to nearest, flush small numbers
// to zero. A call computes in the default one; the host's is back before anything of the host runs.
#pragma once

#include <cstdint>

namespace fmi {

// The control words. On x86 the x87's too: some C libraries print by it. Its precision differs from system to system,
// and the lowest bits of the other word are flags of what has happened. No library has access to all of them.
// NOLINTBEGIN(portability-no-assembler)
#if defined(__x86_64__)
struct ControlWords {
  static constexpr unsigned traps_and_rounding = 0xc3f, x87_default = 0x3f;
  static constexpr std::uint32_t flags = 0x3f, sse_default = 0x1f80;
  std::uint32_t sse;
  std::uint16_t x87;

  void read() { asm volatile("stmxcsr %0\n\tfnstcw %1" : "=m"(sse), "=m"(x87)); }
  void write() const { asm volatile("fnclex\n\tfldcw %1\n\tldmxcsr %0" ::"m"(sse), "m"(x87) : "memory"); }
  bool is_default() const { return (sse & ~flags) == sse_default && (x87 & traps_and_rounding) == x87_default; }
  void set_default() {
    sse = sse_default;
    x87 = static_cast<std::uint16_t>((static_cast<unsigned>(x87) & ~traps_and_rounding) | x87_default);
  }
};
#elif defined(__aarch64__)
struct ControlWords {
  std::uint64_t fpcr;

  void read() { asm volatile("mrs %0, fpcr" : "=r"(fpcr)); }
  void write() const { asm volatile("msr fpcr, %0" ::"r"(fpcr) : "memory"); }
  bool is_default() const { return fpcr == 0; }
  void set_default() { fpcr = 0; }
};
#else
struct ControlWords {
  void read() {}
  void write() const {}
  bool is_default() const { return true; }
  void set_default() {}
};
#endif
// NOLINTEND(portability-no-assembler)

class Arithmetic {
 public:
  void take() {
    ControlWords words;
    words.read();
    differs_ = !words.is_default();
    if (!differs_) return;
    host_ = words;
    words.set_default();
    words.write();
  }
  void give_back() const {
    if (differs_) host_.write();
  }

 private:
  ControlWords host_ = {};
  bool differs_ = false;
};

}  // namespace fmi
