// The vector's operations: those that CVODE asks for, as loops of a length that the compiler knows. One block of memory
// holds SUNDIALS's record and the numbers.
#include "cvode_vector.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>

#include "step.hpp"

namespace solver {
namespace {

// SUNDIALS's record comes first: its address is the vector's, and its content is the numbers.
struct Vector {
  _generic_N_Vector record;
  int states;
  alignas(16) double x[max_states];
};

int states_of(N_Vector v) { return reinterpret_cast<Vector*>(v)->states; }

N_Vector make(int states, N_Vector_Ops operations, SUNContext context) {
  auto* vector = static_cast<Vector*>(std::calloc(1, sizeof(Vector)));
  if (!vector) return nullptr;
  vector->record = {vector->x, operations, context};
  vector->states = states;
  return &vector->record;
}

N_Vector clone(N_Vector v) { return make(states_of(v), v->ops, v->sunctx); }
void destroy(N_Vector v) { std::free(v); }
// A column of a matrix, for the difference quotients.
void set_data(double* x, N_Vector v) { v->content = x; }
N_Vector_ID kind(N_Vector) { return SUNDIALS_NVEC_CUSTOM; }

template <int width>
struct Operations {
  static sunindextype length(N_Vector) { return width; }

  template <class Function>
  static void each(N_Vector z, const Function& f) {
    double result[width];  // the operands may be z itself
    for (int i = 0; i < width; ++i) result[i] = f(i);
    std::memcpy(data(z), result, sizeof result);
  }

  static void linear_sum(double a, N_Vector x, double b, N_Vector y, N_Vector z) {
    const double *u = data(x), *v = data(y);
    if (a == 1 && b == 1) return each(z, [=](int i) { return u[i] + v[i]; });
    each(z, [=](int i) { return a * u[i] + b * v[i]; });
  }

  static void scale(double a, N_Vector x, N_Vector z) {
    each(z, [a, u = data(x)](int i) { return a * u[i]; });
  }

  static void product(N_Vector x, N_Vector y, N_Vector z) {
    const double *u = data(x), *v = data(y);
    each(z, [=](int i) { return u[i] * v[i]; });
  }

  // The padding beyond `states` is zero and stays zero.
  static void constant(double a, N_Vector z) {
    each(z, [a, n = states_of(z)](int i) { return i < n ? a : 0; });
  }
  static void quotient(N_Vector x, N_Vector y, N_Vector z) {
    const double *u = data(x), *v = data(y);
    each(z, [=, n = states_of(z)](int i) { return i < n ? u[i] / v[i] : 0; });
  }
  static void inverse(N_Vector x, N_Vector z) {
    each(z, [u = data(x), n = states_of(z)](int i) { return i < n ? 1 / u[i] : 0; });
  }
  static void add_constant(N_Vector x, double a, N_Vector z) {
    each(z, [=, u = data(x), n = states_of(z)](int i) { return i < n ? u[i] + a : 0; });
  }
  static void absolute(N_Vector x, N_Vector z) {
    each(z, [u = data(x)](int i) { return std::fabs(u[i]); });
  }
  static double largest(N_Vector x) {
    const double* u = data(x);
    return std::fabs(*std::max_element(u, u + width, [](double a, double b) { return std::fabs(a) < std::fabs(b); }));
  }

  static double rms_norm(N_Vector x, N_Vector weights) {
    return weighted_norm<width>(data(x), data(weights), states_of(x));
  }

  // z = sum of c_k x_k; CVODE's dense output. z may be x_0.
  static SUNErrCode combine(int n, double* c, N_Vector* x, N_Vector z) {
    double sum[width] = {};
    for (int k = 0; k < n; ++k) {
      if (c[k] == 0) continue;  // at the end of a step all but one
      const double* u = data(x[k]);
      for (int i = 0; i < width; ++i) sum[i] += c[k] * u[i];
    }
    std::memcpy(data(z), sum, sizeof sum);
    return SUN_SUCCESS;
  }

  // z_k = a_k x + y_k: the end of a step, on all columns of the history at once.
  static SUNErrCode add_to_each(int n, double* a, N_Vector x, N_Vector* y, N_Vector* z) {
    const double* u = data(x);
    for (int k = 0; k < n; ++k) {
      const double* v = data(y[k]);
      each(z[k], [=, factor = a[k]](int i) { return factor * u[i] + v[i]; });
    }
    return SUN_SUCCESS;
  }

  static SUNErrCode scale_each(int n, double* a, N_Vector* x, N_Vector* z) {
    for (int k = 0; k < n; ++k) scale(a[k], x[k], z[k]);
    return SUN_SUCCESS;
  }

  static const _generic_N_Vector_Ops& table() {
    static constexpr _generic_N_Vector_Ops operations = [] {
      _generic_N_Vector_Ops o = {};
      o.nvgetvectorid = kind;
      o.nvclone = o.nvcloneempty = clone;
      o.nvdestroy = destroy;
      o.nvgetarraypointer = [](N_Vector v) { return data(v); };
      o.nvsetarraypointer = set_data;
      o.nvgetlength = length;
      o.nvlinearsum = linear_sum;
      o.nvconst = constant;
      o.nvprod = product;
      o.nvdiv = quotient;
      o.nvscale = scale;
      o.nvabs = absolute;
      o.nvinv = inverse;
      o.nvaddconst = add_constant;
      o.nvmaxnorm = largest;
      o.nvwrmsnorm = rms_norm;
      o.nvlinearcombination = combine;
      o.nvscaleaddmulti = add_to_each;
      o.nvscalevectorarray = scale_each;
      return o;
    }();
    return operations;
  }
};

}  // namespace

// SUNDIALS takes the table of operations by a pointer that could write, and does not.
N_Vector make_vector(int states, SUNContext context) {
  const auto& table = width_of(states) == 8 ? Operations<8>::table() : Operations<max_states>::table();
  return make(states, const_cast<N_Vector_Ops>(&table), context);
}

}  // namespace solver
