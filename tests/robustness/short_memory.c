/* malloc and calloc in front of the C library's or of a sanitizer's, by LD_PRELOAD: those of wheel.so are counted, and
 * fail from one number to another. No paper equation, no frame. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <string.h>

long number, first_failing, last_failing;

static int fails(const void* caller) {
  Dl_info info;
  if (!last_failing || !dladdr(caller, &info) || !info.dli_fname || !strstr(info.dli_fname, "wheel.so")) return 0;
  ++number;
  return number >= first_failing && number <= last_failing;
}

/* Those behind: of the address sanitizer where it is loaded, else of the C library; found without asking the loader,
 * which takes memory itself. */
#define BEHIND(name, ...)           \
  void* __libc_##name(__VA_ARGS__); \
  __attribute__((weak)) void* __interceptor_##name(__VA_ARGS__)
BEHIND(malloc, size_t);
BEHIND(calloc, size_t, size_t);
#define NEXT(name) (__interceptor_##name ? __interceptor_##name : __libc_##name)

void* malloc(size_t size) { return fails(__builtin_return_address(0)) ? NULL : NEXT(malloc)(size); }

void* calloc(size_t count, size_t size) {
  return fails(__builtin_return_address(0)) ? NULL : NEXT(calloc)(count, size);
}
