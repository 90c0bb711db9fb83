/* One instance's life as a sequence of calls that its number alone decides, and the FMU that it is lived in. */
#ifndef THREADS_H
#define THREADS_H

#include "fmu.h"

typedef struct Life Life;
Life* begin_life(const Fmu* fmu, const char* guid, unsigned long number);
/* One more call; 0 where the life is over. */
int go_on(Life* life);
unsigned long number_of(const Life* life);
/* Frees it; the checksum of all outputs, derivatives, states and messages it has seen. */
unsigned long long end_life(Life* life);

unsigned long calls_made(void);

/* Next number of a xorshift sequence. */
unsigned long long draw(unsigned long long* dice);

#endif
