// The vector's operations by SUNDIALS's public interface. Some of them SUNDIALS demands and this wheel never reaches.
#include "vector.hpp"

#include <cstdio>
#include <cstring>
#include <initializer_list>

#include "cvode_vector.hpp"
#include "step.hpp"

void measure_vector(int states) {
  SUNContext context;
  SUNContext_Create(SUN_COMM_NULL, &context);
  N_Vector x = solver::make_vector(states, context), y = N_VClone(x), z = N_VClone(x);
  for (int i = 0; i < states; ++i) solver::data(x)[i] = i - 1.25, solver::data(y)[i] = 2 + i;
  const auto show = [&](const char* name) {
    std::printf("\"%s\": [", name);
    for (int i = 0; i < solver::width_of(states); ++i) std::printf("%s%.17g", i ? ", " : "", solver::data(z)[i]);
    std::printf("], ");
    std::memset(solver::data(z), 0, static_cast<std::size_t>(states) * sizeof(double));
  };
  std::printf("{");
  N_VConst(3, z), show("const");
  N_VLinearSum(2, x, -3, y, z), show("sum");
  N_VProd(x, y, z), show("product");
  N_VDiv(x, y, z), show("quotient");
  N_VScale(-2, x, z), show("scaled");
  N_VAbs(x, z), show("abs");
  N_VInv(x, z), show("inverse");
  N_VAddConst(x, 0.5, z), show("shifted");
  const bool fused = x->ops->nvlinearcombination && x->ops->nvscaleaddmulti && x->ops->nvscalevectorarray;
  std::printf("\"largest\": %.17g, \"norm\": %.17g, \"fused\": %s}\n", N_VMaxNorm(x), N_VWrmsNorm(x, y),
              fused ? "true" : "false");
  for (N_Vector v : {x, y, z}) N_VDestroy(v);
  SUNContext_Free(&context);
}
