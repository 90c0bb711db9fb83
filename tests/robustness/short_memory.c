/* malloc, calloc and free in front of the C library's or of a sanitizer's, by LD_PRELOAD: what wheel.so takes and gives
 * back is counted, and fails where it is told to. No paper equation, no frame. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <string.h>

/* Allocations of these numbers fail, counted since `number` was set to zero; `live`: blocks not given back. */
long number, first_failing, last_failing, failed, live;
static void* blocks[1 << 12];
enum { MOST = sizeof blocks / sizeof *blocks };

static int is_of_the_library(const void* caller) {
  Dl_info info;
  return dladdr(caller, &info) && info.dli_fname && strstr(info.dli_fname, "wheel.so");
}

static int fails(int watched) {
  if (!watched) return 0;
  ++number;
  const int now = number >= first_failing && number <= last_failing;
  failed += now;
  return now;
}

static void* keep(int watched, void* block) {
  if (watched && block && live < MOST) blocks[live++] = block;
  return block;
}

/* By the block, not by the caller: a call at a function's end does not tell who made it. */
static void forget(const void* block) {
  for (long i = live - 1; block && i >= 0; --i)
    if (blocks[i] == block) {
      blocks[i] = blocks[--live];
      return;
    }
}

static void* next(const char* name) { return dlsym(RTLD_NEXT, name); }

void* malloc(size_t size) {
  static void* (*real)(size_t);
  if (!real) *(void**)&real = next("malloc");
  const int watched = is_of_the_library(__builtin_return_address(0));
  return fails(watched) ? NULL : keep(watched, real(size));
}

void* calloc(size_t count, size_t size) {
  static void* (*real)(size_t, size_t);
  if (!real) *(void**)&real = next("calloc");
  const int watched = is_of_the_library(__builtin_return_address(0));
  return fails(watched) ? NULL : keep(watched, real(count, size));
}

void free(void* block) {
  static void (*real)(void*);
  if (!real) *(void**)&real = next("free");
  forget(block);
  real(block);
}
