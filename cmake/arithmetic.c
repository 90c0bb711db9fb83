/* Exit status 0 where C or C++ arithmetic keeps IEEE 754; volatile values are not known to the compiler. */
#if defined(__FAST_MATH__) || defined(__ASSOCIATIVE_MATH__) || defined(__RECIPROCAL_MATH__) || \
    defined(__NO_SIGNED_ZEROS__) || (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__)
#error "parts of -ffast-math"
#endif

static volatile double zero = 0.0, ten = 10.0, large = 1e16, three = 2.9999, divisor = 49.0, one = 1.0,
                       smallest = 2.3e-308;
static volatile float single = 41.0f;

/* In this order, and to double precision: neither 2.9999, nor 0 or 4. */
static int sums(double a, double b) { return (a + b) - a == 2.0 && (a + b) - b == a; }

/* Each term is lost. */
static int series(const volatile double* terms, double a) {
  double x[64];
  double sum = 0.0;
  for (int k = 0; k < 64; ++k) {
    x[k] = k ? *terms : a;
  }
  for (int k = 0; k < 64; ++k) {
    sum += x[k];
  }
  return sum == a;
}

/* No reciprocal: x (1/49) is below 1. */
static int quotients(double d, double* exact) {
  int right = 1;
  for (int k = 0; k < 8; ++k) {
    exact[k] = (k + 1.0) * d / d;
  }
  for (int k = 0; k < 8; ++k) {
    right &= exact[k] == k + 1.0 && (k + 1.0) * 49.0 / d == k + 1.0 && d * (k + 1.0) / 49.0 == k + 1.0;
  }
  return right;
}

static int single_quotients(float d) {
  float exact[64];
  int right = 1;
  for (int k = 0; k < 64; ++k) {
    exact[k] = (float)(k + 1) / d;
  }
  for (int k = 0; k < 64; ++k) {
    volatile float above = (float)(k + 1);
    right &= exact[k] == (float)((double)above / (double)d);
  }
  return right;
}

int main(void) {
  double exact[8];
  const double none = zero / zero, minus = -zero;
  const int special = none != none && 1.0 / (minus + 0.0) > 0.0 && 1.0 / (0.0 * minus) < 0.0;
  const int below = smallest / ten != 0.0, doubles = 0.1 * ten == 1.0;
  return !(special && below && doubles && sums(large, three) && series(&one, large) && quotients(divisor, exact) &&
           single_quotients(single));
}
