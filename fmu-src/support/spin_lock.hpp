// A lock that is held for a few microseconds, by rare calls only. It needs neither memory nor the operating system.
#pragma once

#include <atomic>

namespace support {

class SpinLock {
 public:
  explicit SpinLock(std::atomic_flag& taken) : taken_(taken) {
    while (taken_.test_and_set(std::memory_order_acquire)) {
    }
  }
  ~SpinLock() { taken_.clear(std::memory_order_release); }
  SpinLock(const SpinLock&) = delete;
  SpinLock& operator=(const SpinLock&) = delete;

 private:
  std::atomic_flag& taken_;
};

}  // namespace support
