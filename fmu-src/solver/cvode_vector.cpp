// The vector's operations: those that CVODE asks for, as loops of a length known at compile time. One block of memory
// holds SUNDIALS's record and the numbers.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>

#include "cvode_objects.hpp"
#include "step.hpp"

namespace solver {
namespace {

// SUNDIALS's record comes first: its address is the vector's, and its content is the numbers.
struct Vector {
  _generic_N_Vector record;
  alignas(16) double x[max_states];
};

N_Vector make(N_Vector_Ops operations, SUNContext context) {
  auto* vector = static_cast<Vector*>(std::calloc(1, sizeof(Vector)));
  if (!vector) return nullptr;
  vector->record = {vector->x, operations, context};
  return &vector->record;
}

N_Vector clone(N_Vector v) { return make(v->ops, v->sunctx); }

// z_i = f(i), whose operands may be z itself.
template <int width, class Function>
void each(N_Vector z, const Function& f) {
  double result[width];
  for (int i = 0; i < width; ++i) result[i] = f(i);
  std::memcpy(data(z), result, sizeof result);
}

template <int width>
void scale(double a, N_Vector x, N_Vector z) {
  each<width>(z, [a, u = data(x)](int i) { return a * u[i]; });
}

template <int width>
void linear_sum(double a, N_Vector x, double b, N_Vector y, N_Vector z) {
  const double *u = data(x), *v = data(y);
  if (a == 1 && b == 1) return each<width>(z, [=](int i) { return u[i] + v[i]; });
  each<width>(z, [=](int i) { return a * u[i] + b * v[i]; });
}

// z = sum of c_k x_k; CVODE's dense output. z may be x_0.
template <int width>
SUNErrCode combine(int n, double* c, N_Vector* x, N_Vector z) {
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
template <int width>
SUNErrCode add_to_each(int n, double* a, N_Vector x, N_Vector* y, N_Vector* z) {
  for (int k = 0; k < n; ++k)
    each<width>(z[k], [factor = a[k], u = data(x), v = data(y[k])](int i) { return factor * u[i] + v[i]; });
  return SUN_SUCCESS;
}

// Those without a name of their own serve the first step, or are demanded and never called.
template <int width>
constexpr _generic_N_Vector_Ops make_operations() {
  _generic_N_Vector_Ops o = {};
  o.nvgetvectorid = [](N_Vector) { return SUNDIALS_NVEC_CUSTOM; };
  o.nvclone = o.nvcloneempty = clone;
  o.nvdestroy = [](N_Vector v) { std::free(v); };
  o.nvgetarraypointer = data;
  o.nvsetarraypointer = [](double* column, N_Vector v) { v->content = column; };  // for the difference quotients
  o.nvgetlength = [](N_Vector) -> sunindextype { return width; };
  o.nvconst = [](double a, N_Vector z) { std::fill_n(data(z), width, a); };
  o.nvprod = [](N_Vector x, N_Vector y, N_Vector z) { each<width>(z, [=](int i) { return data(x)[i] * data(y)[i]; }); };
  o.nvdiv = [](N_Vector x, N_Vector y, N_Vector z) { each<width>(z, [=](int i) { return data(x)[i] / data(y)[i]; }); };
  o.nvabs = [](N_Vector x, N_Vector z) { each<width>(z, [=](int i) { return std::fabs(data(x)[i]); }); };
  o.nvinv = [](N_Vector x, N_Vector z) { each<width>(z, [=](int i) { return 1 / data(x)[i]; }); };
  o.nvaddconst = [](N_Vector x, double a, N_Vector z) { each<width>(z, [=](int i) { return data(x)[i] + a; }); };
  o.nvmaxnorm = [](N_Vector x) {
    double largest = 0;
    for (int i = 0; i < width; ++i) largest = std::fmax(largest, std::fabs(data(x)[i]));
    return largest;
  };
  o.nvwrmsnorm = [](N_Vector x, N_Vector weights) { return weighted_norm<width>(data(x), data(weights)); };
  o.nvscale = scale<width>;
  o.nvlinearsum = linear_sum<width>;
  o.nvlinearcombination = combine<width>;
  o.nvscaleaddmulti = add_to_each<width>;
  return o;
}

constexpr _generic_N_Vector_Ops narrow = make_operations<8>(), wide = make_operations<max_states>();

}  // namespace

// SUNDIALS takes the table of operations by a pointer that could write, and does not.
N_Vector make_vector(int states, SUNContext context) {
  return make(const_cast<N_Vector_Ops>(states == 8 ? &narrow : &wide), context);
}

}  // namespace solver
