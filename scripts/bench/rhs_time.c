/* Time of one right-hand side through wheel_equations.h: median and smallest of many repetitions, ns per call.
 *
 * Each repetition runs over states along a sweep of tilt and spin, so that neither the branch predictor nor the caches
 * see one state only. Prints "formulation friction median smallest" a line. */
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "wheel_equations.h"

enum { STATES = 64, ROUNDS = 64, REPETITIONS = 501 };

static const WheelParameters paper = {20, 0.3, 0.05, 0.9, 0.9, 1.8, 9.81, 0.03};
static double states[STATES][WHEEL_MAX_STATES];
static volatile double sink;

static double now_ns(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return 1e9 * (double)t.tv_sec + (double)t.tv_nsec;
}

static int by_size(const void* a, const void* b) {
  double x = *(const double*)a, y = *(const double*)b;
  return (x > y) - (x < y);
}

static void sweep_states(const WheelFormulation* f) {
  for (int i = 0; i < STATES; ++i) {
    double x = (double)i / STATES;
    WheelMotion motion = {1 + x, 0.5 + 1.5 * x, 2 * x, 1 - x, 0.3 * x, -2 + 3 * x, x, -x};
    f->start(&paper, &motion, states[i]);
  }
}

static double times[REPETITIONS]; /* rising, after `measure` */

static void measure(const WheelFormulation* f, const WheelScene* scene) {
  double y_dot[WHEEL_MAX_STATES], sum = 0;
  for (int k = 0; k < REPETITIONS; ++k) {
    double start = now_ns();
    for (int round = 0; round < ROUNDS; ++round)
      for (int i = 0; i < STATES; ++i) sum += f->derivative(scene, states[i], y_dot) + y_dot[1];
    times[k] = (now_ns() - start) / (ROUNDS * STATES);
  }
  sink = sum;
  qsort(times, REPETITIONS, sizeof times[0], by_size);
}

int main(void) {
  const WheelFormulation* formulations[] = {&wheel_reduced, &wheel_multibody};
  const char* names[] = {"no law", "none", "rolling", "held", "regularized"};
  for (int i = 0; i < 2; ++i) {
    sweep_states(formulations[i]);
    for (int kind = WHEEL_FRICTIONLESS; kind <= WHEEL_REGULARIZED; ++kind) {
      WheelScene scene = wheel_scene(&paper, NULL, (WheelFriction){(WheelFrictionKind)kind, -1, 1e-3});
      measure(formulations[i], &scene);
      printf("%s %s %.2f %.2f\n", formulations[i]->name, names[kind], times[REPETITIONS / 2], times[0]);
    }
  }
  return 0;
}
