// To be preloaded: operator new and delete with pages of their own, which are gone once they are freed. Whoever touches
// freed memory is ended by SIGSEGV, wherever it lies on the heap.
#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <new>

// The block's first page holds its length, the others are the caller's.
static std::size_t page() { return static_cast<std::size_t>(sysconf(_SC_PAGESIZE)); }

void* operator new(std::size_t size) {
  const std::size_t length = page() + size;
  void* block = mmap(nullptr, length, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (block == MAP_FAILED) throw std::bad_alloc();
  *static_cast<std::size_t*>(block) = length;
  return static_cast<char*>(block) + page();
}

void operator delete(void* memory) noexcept {
  if (!memory) return;
  void* block = static_cast<char*>(memory) - page();
  munmap(block, *static_cast<std::size_t*>(block));
}

void operator delete(void* memory, std::size_t) noexcept { operator delete(memory); }
