/* Sine and cosine of an angle, the angle of a vector, an angle less whole turns.
 *
 * Sine and cosine are computed side by side: a processor computes two numbers at the cost of one. Remainders in
 * [-pi/4, pi/4] and polynomials of FDLIBM (Sun Microsystems, 1993: e_rem_pio2.c, k_sin.c, k_cos.c). The libm that is
 * linked has the same ones, for one function at a time: by it a wheel that rolls takes 13 to 19 % more instructions. */
#include <math.h>
#include <stdint.h>

#include "frame.h"

typedef uint64_t Bits __attribute__((vector_size(sizeof(Two))));
#define ALL UINT64_MAX
#define SIGN UINT64_C(0x8000000000000000)

/* An angle less n quarter turns, and what `angle` rounds off. */
typedef struct Remainder {
  double angle, tail;
  int n;
} Remainder;

/* False, rarely, where the quarter turns need more digits of pi. */
static inline int remainder_of(double x, Remainder* out) {
  const double quarter = 1.57079632673412561417e+00, quarter_tail = 6.07710050650619224932e-11; /* 33 + 53 bits */
  const double size = fabs(x), per_rad = 6.36619772367581382433e-01;
  double r, w;
  int n = 1;
  *out = (Remainder){x, 0, 0};
  if (size < 0x1.921fbp-1) return 1; /* pi/4 */
  if (!(size < 0x1p19)) return 0;
  if (size < 0x1.2d97cp1) { /* 3 pi/4: the tilt of most wheels */
    r = size - quarter;
    w = quarter_tail;
  } else {
    n = (int)(size * per_rad + 0.5);
    r = size - n * quarter;
    w = n * quarter_tail;
  }
  double angle = r - w, tail = (r - angle) - w;
  *out = x < 0 ? (Remainder){-angle, -tail, -n} : (Remainder){angle, tail, n};
  return fabs(angle) > size * 0x1p-16;
}

/* With z = x^2: sin x = x + z x P(z), cos x = (1 - z/2) + z^2 Q(z), and the parts of first order in the tail of x. */
Sines wheel_sines(double angle) {
  static const Two PQ[] = {{-1.66666666666666324348e-01, 4.16666666666666019037e-02},
                           {8.33333333332248946124e-03, -1.38888888888741095749e-03},
                           {-1.98412698298579493134e-04, 2.48015872894767294178e-05},
                           {2.75573137070700676789e-06, -2.75573143513906633035e-07},
                           {-2.50507602534068634195e-08, 2.08757232129817482790e-09},
                           {1.58969099521155010221e-10, -1.13596475577881948265e-11}};
  static const Bits exchanged[] = {{0, 0}, {ALL, ALL}, {0, 0}, {ALL, ALL}};
  static const Bits signs[] = {{0, 0}, {0, SIGN}, {SIGN, SIGN}, {SIGN, 0}};
  Remainder of;
  if (!remainder_of(angle, &of)) return (Sines){sin(angle), cos(angle)};
  const double x = of.angle, z = x * x, half = 0.5 * z, most = 1 - half;
  const Two large = {x, most}, small = {of.tail - half * of.tail, ((1 - most) - half) - x * of.tail};
  const Two zz = {z, z}, z_4 = zz * zz, factor = {z * x, z * z};
  const Two pq = (PQ[0] + zz * PQ[1]) + z_4 * ((PQ[2] + zz * PQ[3]) + z_4 * (PQ[4] + zz * PQ[5]));
  const Two sines = large + (factor * pq + small), turned = {sines[1], sines[0]};
  /* A quarter turn exchanges sine and cosine, and one of them changes its sign. */
  const unsigned quarters = (unsigned)of.n & 3u;
  const Bits mask = exchanged[quarters];
  const Two out = (Two)((((Bits)sines & ~mask) | ((Bits)turned & mask)) ^ signs[quarters]);
  return (Sines){out[0], out[1]};
}

double wheel_less_turns(double angle) {
  const double pi = 3.141592653589793;
  if (fabs(angle) <= pi) return angle;
  /* The nearest multiple of a rounded 2 pi is off by less than 1e-4 rad; sine and cosine of the whole angle are not. */
  double less = remainder(angle, 2 * pi);
  for (int i = 0; i < 2; ++i) less += sin(angle) * cos(less) - cos(angle) * sin(less);
  return less;
}

double wheel_angle_of(double x, double y) {
  double size = sqrt(x * x + y * y), angle = x < 0 ? copysign(3.141592653589793, y) : 0;
  if (size == 0) return 0;
  /* Each time the sine of the error is taken off. From a quarter turn it falls to 0.57, 0.03, 5e-6, and to rounding. */
  for (int i = 0; i < 4; ++i) angle += y / size * cos(angle) - x / size * sin(angle);
  return angle;
}
