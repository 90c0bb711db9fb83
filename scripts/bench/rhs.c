/* The product's right-hand side as numbalsoda calls it: data points to {scene, formulation}. Frames and names as in
 * wheel_equations.h. */
#include "wheel_equations.h"

typedef struct Problem {
  const WheelScene* scene;
  const WheelFormulation* formulation;
} Problem;

long wheel_rhs_count = 0;

void wheel_rhs(double t, const double* y, double* y_dot, const Problem* problem) {
  (void)t;
  ++wheel_rhs_count;
  problem->formulation->derivative(problem->scene, y, y_dot);
}
