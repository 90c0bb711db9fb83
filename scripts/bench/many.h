/* Many wheels in one process: what an instance costs, and whether its neighbours change its bits. */
#ifndef BENCH_MANY_H
#define BENCH_MANY_H

#include "fmu.h"

/* Prints JSON fields: times and memory per instance, and how many of the instances, stepped in turn and from two
 * threads, ended with other bits than one alone. */
void print_many(const Fmu* fmu, const Run* run);

#endif
