/* A SUNDIALS vector of fixed length, 8 or 12 doubles in one block, with its operations inline. Plain C, since CVODE's
 * own sources are compiled with this header in front (cmake/sundials.cmake): its some sixty vector operations a step
 * become straight code instead of two calls each. CVODE itself is unchanged. No paper equation, no frame. */
#ifndef WHEEL_STATE_VECTOR_H
#define WHEEL_STATE_VECTOR_H

#include <math.h>
#include <stddef.h>

#include <sundials/sundials_nvector.h>

typedef struct StateVector {
  struct _generic_N_Vector header;
  int states;  /* 8 or 12 */
  double x[1]; /* as many */
} StateVector;

#define WHEEL_INLINE static inline __attribute__((always_inline))

/* By address, not by the member's declared length. */
WHEEL_INLINE double* state_data(N_Vector v) { return (double*)((char*)v + offsetof(StateVector, x)); }
WHEEL_INLINE int state_count(N_Vector v) { return ((StateVector*)v)->states; }

/* Two neighbouring entries. Written out as pairs, because compilers turn such short loops into a mix of narrow stores
 * and wide loads of the same place, which costs more than the arithmetic. */
typedef double StatePair __attribute__((vector_size(16), aligned(8), may_alias));

WHEEL_INLINE StatePair* state_pairs(N_Vector v) { return (StatePair*)state_data(v); }

/* z_i = expression in i, over pairs; unrolled for 8 states, the common case. */
#define WHEEL_FILL(z, expression)                                                 \
  do {                                                                            \
    StatePair* out_ = state_pairs(z);                                             \
    const int pairs_ = state_count(z) / 2;                                        \
    if (pairs_ == 4) {                                                            \
      _Pragma("GCC unroll 4") for (int i = 0; i < 4; ++i) out_[i] = (expression); \
    } else {                                                                      \
      for (int i = 0; i < pairs_; ++i) out_[i] = (expression);                    \
    }                                                                             \
  } while (0)

WHEEL_INLINE void state_linear_sum(double a, N_Vector x, double b, N_Vector y, N_Vector z) {
  const StatePair *p = state_pairs(x), *q = state_pairs(y);
  if (a == 1 && b == 1)
    WHEEL_FILL(z, p[i] + q[i]); /* the predictor: some forty of these a step */
  else
    WHEEL_FILL(z, a * p[i] + b * q[i]);
}

WHEEL_INLINE void state_scale(double c, N_Vector x, N_Vector z) {
  const StatePair* p = state_pairs(x);
  WHEEL_FILL(z, c * p[i]);
}

WHEEL_INLINE void state_constant(double c, N_Vector z) {
  const StatePair both = {c, c};
  WHEEL_FILL(z, both);
}

/* Weighted root mean square. */
WHEEL_INLINE double state_wrms_norm(N_Vector x, N_Vector w) {
  const StatePair *p = state_pairs(x), *q = state_pairs(w);
  const int pairs = state_count(x) / 2;
  StatePair sum[2] = {{0, 0}, {0, 0}};
  for (int i = 0; i < pairs; i += 2) {
    const StatePair first = p[i] * q[i], second = p[i + 1] * q[i + 1];
    sum[0] += first * first;
    sum[1] += second * second;
  }
  sum[0] += sum[1];
  return sqrt((sum[0][0] + sum[0][1]) / (2 * pairs));
}

WHEEL_INLINE SUNErrCode state_combine(int count, double* c, N_Vector* x, N_Vector z) {
  const int pairs = state_count(z) / 2;
  StatePair sum[6];
  for (int i = 0; i < pairs; ++i) sum[i] = c[0] * state_pairs(x[0])[i];
  for (int j = 1; j < count; ++j) {
    for (int i = 0; i < pairs; ++i) sum[i] += c[j] * state_pairs(x[j])[i];
  }
  for (int i = 0; i < pairs; ++i) state_pairs(z)[i] = sum[i];
  return SUN_SUCCESS;
}

WHEEL_INLINE SUNErrCode state_add_to_each(int count, double* a, N_Vector x, N_Vector* y, N_Vector* z) {
  const StatePair* p = state_pairs(x);
  for (int j = 0; j < count; ++j) {
    const StatePair* q = state_pairs(y[j]);
    WHEEL_FILL(z[j], a[j] * p[i] + q[i]);
  }
  return SUN_SUCCESS;
}

WHEEL_INLINE SUNErrCode state_scale_each(int count, double* c, N_Vector* x, N_Vector* z) {
  for (int j = 0; j < count; ++j) state_scale(c[j], x[j], z[j]);
  return SUN_SUCCESS;
}

/* Prediction over one step, z_(j-1) += z_j for k = 1 ... q and j = q ... k: the sums of CVODE's cvPredict in the same
 * order, with the history of a pair of states in registers. */
#define WHEEL_PREDICT(q)                                                                                    \
  case q:                                                                                                   \
    for (int i = 0; i < pairs; ++i) {                                                                       \
      StatePair s[q + 1];                                                                                   \
      WHEEL_UNROLL for (int j = 0; j <= q; ++j) s[j] = state_pairs(z[j])[i];                                \
      WHEEL_UNROLL for (int k = 1; k <= q; ++k) WHEEL_UNROLL for (int j = q; j >= k; --j) s[j - 1] += s[j]; \
      WHEEL_UNROLL for (int j = 0; j < q; ++j) state_pairs(z[j])[i] = s[j];                                 \
    }                                                                                                       \
    break
#define WHEEL_UNROLL _Pragma("GCC unroll 16")

static inline void state_predict(N_Vector* z, int order) {
  const int pairs = state_count(z[0]) / 2;
  switch (order) {
    WHEEL_PREDICT(1);
    WHEEL_PREDICT(2);
    WHEEL_PREDICT(3);
    WHEEL_PREDICT(4);
    WHEEL_PREDICT(5);
    WHEEL_PREDICT(6);
    WHEEL_PREDICT(7);
    WHEEL_PREDICT(8);
    WHEEL_PREDICT(9);
    WHEEL_PREDICT(10);
    WHEEL_PREDICT(11);
    WHEEL_PREDICT(12);
    default: /* CVODE has no higher order */
      break;
  }
}

#ifdef WHEEL_INLINE_VECTOR_OPERATIONS
#define N_VLinearSum state_linear_sum
#define N_VScale state_scale
#define N_VConst state_constant
#define N_VWrmsNorm state_wrms_norm
#define N_VLinearCombination state_combine
#define N_VScaleAddMulti state_add_to_each
#define N_VScaleVectorArray state_scale_each
#endif

#endif
