// Pieces of a solver's room, one behind the other. Under the address sanitizer with a gap that must not be touched.
#include "room.hpp"

#include <cstring>

#if defined(__has_feature)
#if __has_feature(address_sanitizer) && !defined(__SANITIZE_ADDRESS__)
#define __SANITIZE_ADDRESS__
#endif
#endif
#ifdef __SANITIZE_ADDRESS__
#include <sanitizer/asan_interface.h>
#else
#define ASAN_POISON_MEMORY_REGION(address, size) (static_cast<void>(address), static_cast<void>(size))
#define ASAN_UNPOISON_MEMORY_REGION(address, size) (static_cast<void>(address), static_cast<void>(size))
#endif

namespace integrator {
namespace {

#ifdef __SANITIZE_ADDRESS__
constexpr std::size_t gap = alignof(Room);
#else
constexpr std::size_t gap = 0;
#endif

std::atomic_flag taken;  // guards the two below
unsigned char* free_begin;
unsigned char* free_end;

}  // namespace

Furnishing::Furnishing(Room& room) : lock_(taken) {
  free_begin = room.bytes;
  free_end = room.bytes + sizeof room.bytes;
  ASAN_POISON_MEMORY_REGION(room.bytes, sizeof room.bytes);
}

Furnishing::~Furnishing() { free_begin = free_end = nullptr; }

}  // namespace integrator

extern "C" {

void* wheel_room_malloc(size_t size) {
  using namespace integrator;
  constexpr std::size_t step = alignof(Room);
  const auto left = static_cast<std::size_t>(free_end - free_begin);
  if (size > left || (size + step - 1) / step * step + gap > left) return nullptr;
  unsigned char* piece = free_begin;
  free_begin += (size + step - 1) / step * step + gap;
  ASAN_UNPOISON_MEMORY_REGION(piece, size);
  return piece;
}

void* wheel_room_calloc(size_t count, size_t size) {
  void* piece = wheel_room_malloc(count * size);
  return piece ? std::memset(piece, 0, count * size) : nullptr;
}

void wheel_room_free(void*) {}

}  // extern "C"
