/* Many wheels in one process: stepped in turn and from two threads, their outputs compared bit by bit with those of
 * one alone; memory by the allocator's own accounting. No paper equation, no frame. */
#include "many.h"

#include <malloc.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct Share {
  const Fmu* fmu;
  const Run* run;
  fmi2Component* instances;
  long first, last; /* instances [first, last) */
} Share;

/* One step of each instance, then the next step of each: neighbours alternate as in a co-simulation. */
static void* step_in_turn(void* data) {
  const Share* share = data;
  const long steps = (long)(share->run->stop / share->run->step + 0.5);
  for (long k = 0; k < steps; ++k)
    for (long i = share->first; i < share->last; ++i)
      share->fmu->do_step(share->instances[i], (double)k * share->run->step, share->run->step, fmi2True);
  return NULL;
}

static size_t bytes_in_use(void) {
  const struct mallinfo2 info = mallinfo2();
  return info.uordblks + info.hblkhd;
}

/* How many of the instances have other outputs than `alone`. */
static long count_different(const Share* all, const double* alone) {
  long different = 0;
  for (long i = all->first; i < all->last; ++i) {
    double outputs[MOST_READ] = {0};
    all->fmu->get_real(all->instances[i], all->run->outputs, all->run->output_count, outputs);
    different += memcmp(outputs, alone, all->run->output_count * sizeof *alone) != 0;
  }
  return different;
}

/* All instances from start to free. Bytes and seconds are per instance. */
static void run_crowd(const Fmu* fmu, const Run* run, int threads, const double* alone) {
  fmi2Component* instances = calloc((size_t)run->instances, sizeof *instances);
  const size_t bytes_before = bytes_in_use();
  const double t_0 = now();
  for (long i = 0; i < run->instances; ++i) instances[i] = start_instance(fmu, run);
  const double t_1 = now();
  const size_t bytes_started = bytes_in_use();
  Share all = {fmu, run, instances, 0, run->instances};
  Share halves[2] = {all, all};
  halves[0].last = halves[1].first = run->instances / 2;
  if (threads == 2) {
    pthread_t other;
    pthread_create(&other, NULL, step_in_turn, &halves[0]);
    step_in_turn(&halves[1]);
    pthread_join(other, NULL);
  } else {
    step_in_turn(&all);
  }
  const double t_2 = now();
  const size_t bytes_stepped = bytes_in_use();
  const long different = count_different(&all, alone);
  const double t_3 = now(), each = 1.0 / (double)run->instances;
  for (long i = 0; i < run->instances; ++i) fmu->free_instance(instances[i]);
  printf("\"%d\": {\"start\": %.9g, \"solve\": %.9g, \"free\": %.9g, ", threads, (t_1 - t_0) * each, (t_2 - t_1) * each,
         (now() - t_3) * each);
  printf("\"bytes\": %.9g, \"bytes_stepped\": %.9g, \"bytes_left\": %.9g, \"different\": %ld}%s",
         (double)(bytes_started - bytes_before) * each, (double)(bytes_stepped - bytes_before) * each,
         (double)bytes_in_use() - (double)bytes_before, different, threads == 1 ? ", " : "");
  free(instances);
}

void print_many(const Fmu* fmu, const Run* run) {
  double alone[MOST_READ] = {0};
  fmi2Component one = start_instance(fmu, run);
  if (!one) return (void)printf("\"status\": 3");
  Share single = {fmu, run, &one, 0, 1};
  step_in_turn(&single);
  fmu->get_real(one, run->outputs, run->output_count, alone);
  fmu->free_instance(one);
  printf("\"instances\": %ld, \"threads\": {", run->instances);
  run_crowd(fmu, run, 1, alone);
  run_crowd(fmu, run, 2, alone);
  printf("}");
}
