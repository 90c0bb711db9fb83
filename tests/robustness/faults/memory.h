/* The process's allocator under watch: counted, filled with a pattern, and failed where it is told to. No paper
 * equation, no frame. */
#ifndef FAULTS_MEMORY_H
#define FAULTS_MEMORY_H

#include <stddef.h>

typedef struct Memory {
  int watched;
  long taken, live;               /* allocations, blocks not given back; since watch() */
  long fail_first, fail_last;     /* the allocations of these numbers get null; 0: none */
  long failed;                    /* how many did */
  unsigned char fill;             /* what fresh memory holds */
  size_t largest, largest_unused; /* of a block given back: bytes, and the longest row of them never written */
} Memory;

extern Memory memory;

/* From now on; fails the allocations first to last. */
void watch(unsigned char fill, long first, long last);

#endif
