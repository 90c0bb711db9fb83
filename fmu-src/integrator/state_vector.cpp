// The operations of the fixed-length vector that CVODE, its fixed-point and its dense Newton solver call.
#include "state_vector.hpp"

#include <cmath>
#include <cstdlib>
#include <cstring>

namespace integrator {
namespace {

template <int n>
struct Vector {
  _generic_N_Vector header;
  double x[n];
};

template <int n>
double* at(N_Vector v) {
  return reinterpret_cast<Vector<n>*>(v)->x;
}

template <int n>
struct Operations {
  static N_Vector make(SUNContext context) {
    auto* v = static_cast<Vector<n>*>(std::calloc(1, sizeof(Vector<n>)));
    if (!v) return nullptr;
    v->header = {v, table(), context};
    return &v->header;
  }
  static N_Vector clone(N_Vector w) { return make(w->sunctx); }
  static void destroy(N_Vector v) { std::free(v); }
  static double* array(N_Vector v) { return at<n>(v); }
  static sunindextype length(N_Vector) { return n; }
  static void space(N_Vector, sunindextype* reals, sunindextype* integers) { *reals = n, *integers = 0; }
  static N_Vector_ID id(N_Vector) { return SUNDIALS_NVEC_CUSTOM; }

  // All entries are computed before the first is stored: z may be an operand, and no check for that is needed.
  template <class F>
  static void fill(N_Vector z, F&& entry) {
    double entries[n];
    for (int i = 0; i < n; ++i) entries[i] = entry(i);
    std::memcpy(at<n>(z), entries, sizeof entries);
  }
  // The predictor adds and subtracts columns of the history some thirty times a step.
  static void linear_sum(double a, N_Vector x, double b, N_Vector y, N_Vector z) {
    const double *p = at<n>(x), *q = at<n>(y);
    if (a == 1 && b == 1) return fill(z, [=](int i) { return p[i] + q[i]; });
    fill(z, [=](int i) { return a * p[i] + b * q[i]; });
  }
  static void constant(double c, N_Vector z) {
    fill(z, [=](int) { return c; });
  }
  static void product(N_Vector x, N_Vector y, N_Vector z) {
    const double *p = at<n>(x), *q = at<n>(y);
    fill(z, [=](int i) { return p[i] * q[i]; });
  }
  static void quotient(N_Vector x, N_Vector y, N_Vector z) {
    const double *p = at<n>(x), *q = at<n>(y);
    fill(z, [=](int i) { return p[i] / q[i]; });
  }
  static void scale(double c, N_Vector x, N_Vector z) {
    const double* p = at<n>(x);
    fill(z, [=](int i) { return c * p[i]; });
  }
  static void absolute(N_Vector x, N_Vector z) {
    const double* p = at<n>(x);
    fill(z, [=](int i) { return std::fabs(p[i]); });
  }
  static void inverse(N_Vector x, N_Vector z) {
    const double* p = at<n>(x);
    fill(z, [=](int i) { return 1 / p[i]; });
  }
  static void add_constant(N_Vector x, double b, N_Vector z) {
    const double* p = at<n>(x);
    fill(z, [=](int i) { return p[i] + b; });
  }
  static double dot(N_Vector x, N_Vector y) {
    const double *p = at<n>(x), *q = at<n>(y);
    double sum = 0;
    for (int i = 0; i < n; ++i) sum += p[i] * q[i];
    return sum;
  }
  static double largest(N_Vector x) {
    double most = 0;
    for (int i = 0; i < n; ++i) most = std::fmax(most, std::fabs(at<n>(x)[i]));
    return most;
  }
  static double least(N_Vector x) {
    double least = at<n>(x)[0];
    for (int i = 1; i < n; ++i) least = std::fmin(least, at<n>(x)[i]);
    return least;
  }
  // Weighted root mean square. Four sums side by side, so that no addition waits for the one before.
  static double weighted_norm(N_Vector x, N_Vector w) {
    const double *p = at<n>(x), *q = at<n>(w);
    double sum[4] = {};
    for (int i = 0; i < n; ++i) sum[i % 4] += (p[i] * q[i]) * (p[i] * q[i]);
    return std::sqrt(((sum[0] + sum[2]) + (sum[1] + sum[3])) / n);
  }
  static SUNErrCode combine(int count, double* c, N_Vector* x, N_Vector z) {
    double sum[n] = {};
    for (int j = 0; j < count; ++j) {
      const double* p = at<n>(x[j]);
      for (int i = 0; i < n; ++i) sum[i] += c[j] * p[i];
    }
    fill(z, [&](int i) { return sum[i]; });
    return SUN_SUCCESS;
  }
  static SUNErrCode add_to_each(int count, double* a, N_Vector x, N_Vector* y, N_Vector* z) {
    for (int j = 0; j < count; ++j) linear_sum(a[j], x, 1, y[j], z[j]);
    return SUN_SUCCESS;
  }
  static SUNErrCode scale_each(int count, double* c, N_Vector* x, N_Vector* z) {
    for (int j = 0; j < count; ++j) scale(c[j], x[j], z[j]);
    return SUN_SUCCESS;
  }

  static N_Vector_Ops table();
};

template <int n>
_generic_N_Vector_Ops make_table() {
  using O = Operations<n>;
  _generic_N_Vector_Ops ops = {};
  ops.nvgetvectorid = O::id;
  ops.nvclone = ops.nvcloneempty = O::clone;
  ops.nvdestroy = O::destroy;
  ops.nvspace = O::space;
  ops.nvgetarraypointer = O::array;
  ops.nvgetlength = ops.nvgetlocallength = O::length;
  ops.nvlinearsum = O::linear_sum;
  ops.nvconst = O::constant;
  ops.nvprod = O::product;
  ops.nvdiv = O::quotient;
  ops.nvscale = O::scale;
  ops.nvabs = O::absolute;
  ops.nvinv = O::inverse;
  ops.nvaddconst = O::add_constant;
  ops.nvdotprod = O::dot;
  ops.nvmaxnorm = O::largest;
  ops.nvmin = O::least;
  ops.nvwrmsnorm = O::weighted_norm;
  ops.nvlinearcombination = O::combine;
  ops.nvscaleaddmulti = O::add_to_each;
  ops.nvscalevectorarray = O::scale_each;
  return ops;
}

// Shared by all vectors of one length and never written: SUNDIALS asks for a non-const pointer.
_generic_N_Vector_Ops table_8 = make_table<8>();
_generic_N_Vector_Ops table_12 = make_table<12>();

template <>
N_Vector_Ops Operations<8>::table() {
  return &table_8;
}
template <>
N_Vector_Ops Operations<12>::table() {
  return &table_12;
}

}  // namespace

N_Vector make_state_vector(int states, SUNContext context) {
  if (states == 8) return Operations<8>::make(context);
  if (states == 12) return Operations<12>::make(context);
  return nullptr;
}

double* data(N_Vector v) { return N_VGetArrayPointer(v); }

}  // namespace integrator
