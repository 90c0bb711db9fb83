/* Many instances, two threads, every call in random order, FMU states and a talking logger among them; each instance's
   outputs are compared bit by bit with those of the same life lived alone.

   threads LIBRARY GUID INSTANCES: status 1 if a bit differs or a call is refused. Made for the thread sanitizer and for
   valgrind; a life is a function of its number alone, so its order within the crowd must not matter. */
#include "threads.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { THREADS = 2, AT_ONCE = 16 };

typedef struct Crowd {
  const Fmu* fmu;
  const char* guid;
  unsigned long count, first, step;
  unsigned long long* sums; /* by instance */
} Crowd;

/* Lives of numbers first, first + step, ...: AT_ONCE under way, and which one goes on is drawn anew each time. */
static void* live_together(void* data) {
  const Crowd* crowd = data;
  Life* under_way[AT_ONCE] = {NULL};
  unsigned long next = crowd->first, alive = 0;
  unsigned long long dice = 0x9e3779b97f4a7c15u + crowd->first;
  while (next < crowd->count || alive) {
    Life** life = &under_way[draw(&dice) % AT_ONCE];
    if (!*life && next < crowd->count) {
      *life = begin_life(crowd->fmu, crowd->guid, next);
      next += crowd->step;
      ++alive;
    }
    if (*life && !go_on(*life)) {
      crowd->sums[number_of(*life)] = end_life(*life);
      *life = NULL;
      --alive;
    }
  }
  return NULL;
}

int main(int argument_count, char** arguments) {
  if (argument_count < 4) return 2;
  const Fmu fmu = fmu_of(arguments[1]);
  const unsigned long count = strtoul(arguments[3], NULL, 10);
  unsigned long long* sums = calloc(2 * count, sizeof *sums);
  Crowd halves[THREADS];
  pthread_t threads[THREADS];
  for (unsigned long k = 0; k < THREADS; ++k) {
    halves[k] = (Crowd){&fmu, arguments[2], count, k, THREADS, sums};
    pthread_create(&threads[k], NULL, live_together, &halves[k]);
  }
  for (unsigned long k = 0; k < THREADS; ++k) pthread_join(threads[k], NULL);
  unsigned long different = 0, alike = 0;
  for (unsigned long number = 0; number < count; ++number) {
    Life* alone = begin_life(&fmu, arguments[2], number);
    while (go_on(alone)) {
    }
    different += end_life(alone) != sums[number];
    alike += number > 0 && sums[number] == sums[number - 1]; /* the partner: lives that differ have other sums */
  }
  printf("%lu instances on %d threads, %lu calls, %lu with other bits than alone, %lu with those of a neighbour\n",
         count, THREADS, calls_made(), different, alike);
  free(sums);
  return different > 0 || alike > 0;
}
