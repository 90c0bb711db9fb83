// sin and cos of FDLIBM in one piece, so that a compiler sees through their calls, and sincos with the bits of both: a
// reduction to [-pi/4, pi/4] and two polynomials. Compilers merge sin(x) and cos(x) into sincos. No part of the paper.
#include "fdlibm.h"

static double __kernel_sin(double x, double tail, int has_tail);
static double __kernel_cos(double x, double tail);
static int32_t __ieee754_rem_pio2(double x, double* y);

#define half half_in_k_sin  // two of the sources define it
#include "k_sin.c"
#undef half
#include "e_rem_pio2.c"
#include "k_cos.c"
#include "s_cos.c"
#include "s_sin.c"

void sincos(double x, double* sine, double* cosine) {
  double y[2];
  int32_t high;
  GET_HIGH_WORD(high, x);
  high &= 0x7fffffff;
  if (high <= 0x3fe921fb) {  // |x| <= pi/4, about
    *sine = __kernel_sin(x, 0, 0);
    *cosine = __kernel_cos(x, 0);
    return;
  }
  const uint64_t quadrant = __ieee754_rem_pio2(x, y) & 3;  // nan where x is not finite
  const double s = __kernel_sin(y[0], y[1], 1), c = __kernel_cos(y[0], y[1]);
  const uint64_t swap = (bits_of(s) ^ bits_of(c)) & -(quadrant & 1);  // masks, for branches would be guessed wrong
  *sine = of_bits(bits_of(s) ^ swap ^ quadrant >> 1 << 63);
  *cosine = of_bits(bits_of(c) ^ swap ^ (quadrant + 1) >> 1 << 63);
}
