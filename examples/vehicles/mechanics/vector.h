/* Vectors of three numbers and matrices of nine. */
#ifndef VECTOR_H
#define VECTOR_H

static inline double dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

static inline void cross(const double a[3], const double b[3], double c[3]) {
  c[0] = a[1] * b[2] - a[2] * b[1];
  c[1] = a[2] * b[0] - a[0] * b[2];
  c[2] = a[0] * b[1] - a[1] * b[0];
}

/* y = R x and y = R^T x: from body axes to fixed axes and back. */
static inline void to_fixed(double R[3][3], const double x[3], double y[3]) {
  for (int i = 0; i < 3; ++i) y[i] = R[i][0] * x[0] + R[i][1] * x[1] + R[i][2] * x[2];
}

static inline void to_body(double R[3][3], const double x[3], double y[3]) {
  for (int i = 0; i < 3; ++i) y[i] = R[0][i] * x[0] + R[1][i] * x[1] + R[2][i] * x[2];
}

#endif
