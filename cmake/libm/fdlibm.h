// In the place of newlib's fdlibm.h, for the few of its sources that are compiled in (cmake/libm.cmake): the words of a
// double, and the names under which these sources call each other. No part of the paper.
#ifndef WHEEL_FDLIBM_H
#define WHEEL_FDLIBM_H

#include <math.h>
#include <stdint.h>
#include <string.h>

#define __int32_t int32_t
#define __uint32_t uint32_t
#define __ieee754_exp exp
#define __ieee754_cosh cosh

static inline uint64_t bits_of(double x) {
  uint64_t bits;
  memcpy(&bits, &x, sizeof bits);
  return bits;
}

static inline double of_bits(uint64_t bits) {
  double x;
  memcpy(&x, &bits, sizeof x);
  return x;
}

#define GET_HIGH_WORD(high, x) ((high) = (int32_t)(bits_of(x) >> 32))
#define GET_LOW_WORD(low, x) ((low) = (uint32_t)bits_of(x))
#define INSERT_WORDS(x, high, low) ((x) = of_bits((uint64_t)(uint32_t)(high) << 32 | (uint32_t)(low)))
#define SET_HIGH_WORD(x, high) ((x) = of_bits((uint64_t)(uint32_t)(high) << 32 | (uint32_t)bits_of(x)))
#define SET_LOW_WORD(x, low) ((x) = of_bits(bits_of(x) >> 32 << 32 | (uint32_t)(low)))

int __kernel_rem_pio2(double* x, double* y, int e0, int nx, int prec, const int32_t* two_over_pi);

#endif
