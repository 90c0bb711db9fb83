// Rates of the reactions, d lambda/dt, for both formulations: the equations evaluated on numbers that carry their time
// derivative (Eigen's automatic differentiation, one direction: along the motion).
#include <Eigen/Core>
#include <cmath>
#include <unsupported/Eigen/AutoDiff>

#include "multibody.hpp"
#include "wheel_equations.h"

namespace wheel {
namespace {

using Rate = Eigen::Matrix<double, 1, 1>;
using real = Eigen::AutoDiffScalar<Rate>;

real real_of(double value) { return {value, Rate::Zero()}; }
real moving(double value, double rate) { return {value, Rate::Constant(rate)}; }
double real_value(const real& x) { return x.value(); }
real real_sin(const real& x) { return sin(x); }
real real_cos(const real& x) { return cos(x); }
real real_tanh(const real& x) { return tanh(x); }

#include "reduced_system.inc"

Load moving_load(const WheelScene& scene, const WheelLoad* load_dot) {
  Load load;
  for (int i = 0; i < 3; ++i) {
    load.F[i] = moving(scene.loaded ? scene.load.F[i] : 0, load_dot ? load_dot->F[i] : 0);
    load.M[i] = moving(scene.loaded ? scene.load.M[i] : 0, load_dot ? load_dot->M[i] : 0);
  }
  return load;
}

template <int states>
void moving_state(const WheelFormulation& formulation, const WheelScene& scene, const double* y, real* out) {
  double y_dot[states];
  formulation.derivative(&scene, y, y_dot);
  for (int i = 0; i < states; ++i) out[i] = moving(y[i], y_dot[i]);
}

}  // namespace
}  // namespace wheel

extern "C" {

void wheel_reduced_reaction_rates(const WheelScene* scene, const WheelLoad* load_dot, const double* y,
                                  double lambda_dot[3]) {
  using namespace wheel;
  real state[WHEEL_REDUCED_STATES], lambda[3];
  moving_state<WHEEL_REDUCED_STATES>(wheel_reduced, *scene, y, state);
  const Load load = moving_load(*scene, load_dot);
  const Carrier carrier = carrier_of(&scene->wheel, state);
  const Motion motion = motion_of(scene, &load, &carrier, state[4]);
  turn_reaction(&carrier, &motion, state[4], lambda);
  for (int i = 0; i < 3; ++i) lambda_dot[i] = lambda[i].derivatives()[0];
}

void wheel_multibody_reaction_rates(const WheelScene* scene, const WheelLoad* load_dot, const double* y,
                                    double lambda_dot[3]) {
  using namespace wheel;
  real state[WHEEL_MULTIBODY_STATES];
  moving_state<WHEEL_MULTIBODY_STATES>(wheel_multibody, *scene, y, state);
  const Load load = moving_load(*scene, load_dot);
  const paper::Multibody<real> body(scene->wheel, state);
  const paper::Solution<real> solution =
      paper::solve<real>(scene->friction, body, {load.F[0], load.F[1], load.F[2]}, {load.M[0], load.M[1], load.M[2]});
  for (int i = 0; i < 3; ++i) lambda_dot[i] = solution.unknowns[6 + i].derivatives()[0];
}

}  // extern "C"
