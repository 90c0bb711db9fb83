// The operation table of the fixed-length vector, for all of SUNDIALS that is not compiled with the operations inline.
#include "state_vector.hpp"

#include <cmath>

#include "room.hpp"

namespace integrator {
namespace {

N_Vector_Ops table();

N_Vector make(int states, SUNContext context) {
  const std::size_t size = sizeof(StateVector) + sizeof(double) * static_cast<std::size_t>(states);
  auto* v = static_cast<StateVector*>(wheel_room_calloc(1, size));
  if (!v) return nullptr;
  v->header = {v, table(), context};
  v->states = states;
  return &v->header;
}

N_Vector clone(N_Vector w) { return make(state_count(w), w->sunctx); }
void destroy(N_Vector) {}  // it goes with its room
N_Vector_ID id(N_Vector) { return SUNDIALS_NVEC_CUSTOM; }
sunindextype length(N_Vector v) { return state_count(v); }

void space(N_Vector v, sunindextype* reals, sunindextype* integers) {
  *reals = state_count(v);
  *integers = 1;
}

void linear_sum(double a, N_Vector x, double b, N_Vector y, N_Vector z) { state_linear_sum(a, x, b, y, z); }
void scale(double c, N_Vector x, N_Vector z) { state_scale(c, x, z); }
void constant(double c, N_Vector z) { state_constant(c, z); }
double norm(N_Vector x, N_Vector w) { return state_wrms_norm(x, w); }

void product(N_Vector x, N_Vector y, N_Vector z) { WHEEL_FILL(z, state_pairs(x)[i] * state_pairs(y)[i]); }
void quotient(N_Vector x, N_Vector y, N_Vector z) { WHEEL_FILL(z, state_pairs(x)[i] / state_pairs(y)[i]); }
void inverse(N_Vector x, N_Vector z) { WHEEL_FILL(z, 1.0 / state_pairs(x)[i]); }
void add_constant(N_Vector x, double b, N_Vector z) { WHEEL_FILL(z, state_pairs(x)[i] + b); }

void absolute(N_Vector x, N_Vector z) {
  for (int i = 0; i < state_count(x); ++i) state_data(z)[i] = std::fabs(state_data(x)[i]);
}

double dot(N_Vector x, N_Vector y) {
  double sum = 0;
  for (int i = 0; i < state_count(x); ++i) sum += state_data(x)[i] * state_data(y)[i];
  return sum;
}

double largest(N_Vector x) {
  double most = 0;
  for (int i = 0; i < state_count(x); ++i) most = std::fmax(most, std::fabs(state_data(x)[i]));
  return most;
}

double least(N_Vector x) {
  double lowest = state_data(x)[0];
  for (int i = 1; i < state_count(x); ++i) lowest = std::fmin(lowest, state_data(x)[i]);
  return lowest;
}

_generic_N_Vector_Ops make_table() {
  _generic_N_Vector_Ops ops = {};
  ops.nvgetvectorid = id;
  ops.nvclone = ops.nvcloneempty = clone;
  ops.nvdestroy = destroy;
  ops.nvspace = space;
  ops.nvgetarraypointer = state_data;
  ops.nvgetlength = ops.nvgetlocallength = length;
  ops.nvlinearsum = linear_sum;
  ops.nvconst = constant;
  ops.nvprod = product;
  ops.nvdiv = quotient;
  ops.nvscale = scale;
  ops.nvabs = absolute;
  ops.nvinv = inverse;
  ops.nvaddconst = add_constant;
  ops.nvdotprod = dot;
  ops.nvmaxnorm = largest;
  ops.nvmin = least;
  ops.nvwrmsnorm = norm;
  ops.nvlinearcombination = state_combine;
  ops.nvscaleaddmulti = state_add_to_each;
  ops.nvscalevectorarray = state_scale_each;
  return ops;
}

// Shared by all vectors and never written: SUNDIALS asks for a non-const pointer.
_generic_N_Vector_Ops operations = make_table();

N_Vector_Ops table() { return &operations; }

}  // namespace

N_Vector make_state_vector(int states, SUNContext context) {
  return states == 8 || states == 12 ? make(states, context) : nullptr;
}

}  // namespace integrator
