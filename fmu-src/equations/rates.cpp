// Exact derivatives of both formulations: rates of the reactions along the motion, and Jacobians. The equations are
// evaluated on numbers that carry a derivative in one direction (Eigen's automatic differentiation).
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

// K x = b along the motion: K x_dot = b_dot - K_dot x.
template <>
class paper::Factors<real> {
 public:
  explicit Factors(const paper::Matrix9<real>& K) : lu_(K.unaryExpr(&value_of)), K_dot_(K.unaryExpr(&rate_of)) {}
  paper::Vector9<real> solve(const paper::Vector9<real>& column) const {
    const paper::Vector9<double> x = lu_.solve(column.unaryExpr(&value_of));
    const paper::Vector9<double> x_dot = lu_.solve(column.unaryExpr(&rate_of) - K_dot_ * x);
    return x.binaryExpr(x_dot, &moving);
  }

 private:
  static double value_of(const real& x) { return x.value(); }
  static double rate_of(const real& x) { return x.derivatives()[0]; }
  Eigen::PartialPivLU<paper::Matrix9<double>> lu_;
  paper::Matrix9<double> K_dot_;
};

namespace {

// Column after column: f evaluated with a unit derivative in one entry of the state.
template <int states, class F>
void differentiate(const double* y, double* J, F&& f) {
  for (int j = 0; j < states; ++j) {
    real state[states], rate[states];
    for (int i = 0; i < states; ++i) state[i] = moving(y[i], i == j);
    f(state, rate);
    for (int i = 0; i < states; ++i) J[i + states * j] = rate[i].derivatives()[0];
  }
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
  const paper::Vector9<real> column =
      paper::system_column<real>(body, {load.F[0], load.F[1], load.F[2]}, {load.M[0], load.M[1], load.M[2]});
  const paper::Solution<real> solution = paper::solve<real>(scene->friction, body, column);
  for (int i = 0; i < 3; ++i) lambda_dot[i] = solution.unknowns[6 + i].derivatives()[0];
}

void wheel_reduced_jacobian(const WheelScene* scene, const double* y, double* J) {
  using namespace wheel;
  const Load load = moving_load(*scene, nullptr);
  differentiate<WHEEL_REDUCED_STATES>(
      y, J, [&](const real* state, real* rate) { derivative_of(scene, scene->loaded ? &load : nullptr, state, rate); });
}

void wheel_multibody_jacobian(const WheelScene* scene, const double* y, double* J) {
  using namespace wheel;
  const Load load = moving_load(*scene, nullptr);
  const paper::Vector3<real> force(load.F[0], load.F[1], load.F[2]), moment(load.M[0], load.M[1], load.M[2]);
  differentiate<WHEEL_MULTIBODY_STATES>(
      y, J, [&](const real* state, real* rate) { paper::state_rate<real>(*scene, force, moment, state, rate); });
}

}  // extern "C"
