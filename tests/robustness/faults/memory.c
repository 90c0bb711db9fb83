/* malloc and its kin in front of the C library's, or of the address sanitizer's: a program's own definitions win for
 * every library it loads. */
#define _GNU_SOURCE
#include "memory.h"

#include <dlfcn.h>
#include <malloc.h>
#include <stdlib.h>
#include <string.h>

Memory memory;

static struct {
  void* (*malloc)(size_t);
  void* (*calloc)(size_t, size_t);
  void* (*realloc)(void*, size_t);
  void (*free)(void*);
} next;

static void find_next(void) {
  static const char* const names[] = {"malloc", "calloc", "realloc", "free"};
  void* pointers[4];
  for (int i = 0; i < 4; ++i) pointers[i] = dlsym(RTLD_NEXT, names[i]);
  memcpy(&next, pointers, sizeof next);
}

void watch(unsigned char fill, long first, long last) {
  memory = (Memory){.watched = 1, .fail_first = first, .fail_last = last, .fill = fill};
}

static int fails(void) {
  if (!memory.watched) return 0;
  ++memory.taken;
  const int now = memory.taken >= memory.fail_first && memory.taken <= memory.fail_last;
  memory.failed += now;
  return now;
}

static void note_unused(const unsigned char* block) {
  const size_t size = malloc_usable_size((void*)block);
  if (size <= memory.largest) return;
  memory.largest = size;
  memory.largest_unused = 0;
  for (size_t i = 0, row = 0; i < size; ++i) {
    row = block[i] == memory.fill ? row + 1 : 0;
    if (row > memory.largest_unused) memory.largest_unused = row;
  }
}

void* malloc(size_t size) {
  if (!next.malloc) find_next();
  if (fails()) return NULL;
  memory.live += memory.watched;
  void* block = next.malloc(size);
  return memory.watched && block ? memset(block, memory.fill, size) : block;
}

void* calloc(size_t count, size_t size) {
  if (!next.calloc) find_next();
  if (fails()) return NULL;
  memory.live += memory.watched;
  return next.calloc(count, size);
}

void* realloc(void* old, size_t size) {
  if (!next.realloc) find_next();
  if (fails()) return NULL;
  if (!old) memory.live += memory.watched;
  return next.realloc(old, size);
}

void free(void* block) {
  if (!next.free) find_next();
  if (block && memory.watched) {
    --memory.live;
    note_unused(block);
  }
  next.free(block);
}
