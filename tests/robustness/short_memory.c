/* malloc, calloc and free in front of the C library's or of a sanitizer's, by LD_PRELOAD: what wheel.so takes and gives
 * back is counted, fails where it is asked to, and stays in place if so wanted. No paper equation, no frame. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <string.h>

/* While `watching`, allocations of these numbers fail, counted since `number` was set to zero; `live`: blocks not given
 * back. While `holding`, what is given back is kept as it is. */
long watching, number, first_failing, last_failing, failed, live, holding;
static void* blocks[1 << 12];
enum { MOST = sizeof blocks / sizeof *blocks };

static int is_of_the_library(const void* caller) {
  Dl_info info;
  return watching && dladdr(caller, &info) && info.dli_fname && strstr(info.dli_fname, "wheel.so");
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

/* By the block, not by the caller: a call at a function's end does not show who made it. */
static int forget(const void* block) {
  for (long i = live - 1; block && i >= 0; --i)
    if (blocks[i] == block) {
      blocks[i] = blocks[--live];
      return 1;
    }
  return 0;
}

/* Those behind: of the address sanitizer where it is loaded, else of the C library; found without asking the loader,
 * which takes memory itself. */
#define BEHIND(result, name, ...)    \
  result __libc_##name(__VA_ARGS__); \
  __attribute__((weak)) result __interceptor_##name(__VA_ARGS__)
BEHIND(void*, malloc, size_t);
BEHIND(void*, calloc, size_t, size_t);
BEHIND(void, free, void*);
#define NEXT(name) (__interceptor_##name ? __interceptor_##name : __libc_##name)

void* malloc(size_t size) {
  const int watched = is_of_the_library(__builtin_return_address(0));
  return fails(watched) ? NULL : keep(watched, NEXT(malloc)(size));
}

void* calloc(size_t count, size_t size) {
  const int watched = is_of_the_library(__builtin_return_address(0));
  return fails(watched) ? NULL : keep(watched, NEXT(calloc)(count, size));
}

void free(void* block) {
  if (!forget(block) || !holding) NEXT(free)(block);
}
