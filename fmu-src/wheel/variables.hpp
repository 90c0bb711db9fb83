// The FMU's variables as one table, in the order of the description. Names, types, roles, start values and limits
// come from modelDescription.xml at build time (variables.inc, by tools/wheelfmu/fmu/variable_rows.py). How a
// calculated variable is read, and further limits, stand in variables.cpp; that of theta_start, and rules
// about several parameters, in setup.cpp.
// Units and frames: docs/variables.md.
#pragma once

#include <limits>

#include "wheel_equations.h"

namespace wheel {

class Reading;

// How the wheel moves, the force of the ground on it, N, in fixed axes, and the moments about the axle; or the rates of
// these by some quantity.
struct Acting {
  WheelKinematics motion;
  double lambda[3];
  WheelAxleMoment axle;
};

enum class Type : unsigned char { real, integer, boolean, string };  // no variable is a string
enum class Role : unsigned char { parameter, tunable, input, output, local };

// The rows' places by name: parameters and inputs, which keep a value, then the variables that are computed on request.
namespace variable {
enum Place : unsigned {
#define STORED(name, ...) name,
#define COMPUTED(name, ...) name,
#include "variables.inc"
  count,
};
}  // namespace variable

// F_X F_Y F_Z M_1 M_2 M_3 M_brake psi_dot_guide theta_dot_guide are the last of the stored variables.
inline constexpr unsigned first_input = variable::F_X, stored_count = variable::X_O, variable_count = variable::count;

enum Formulation : int { automatic_formulation = 1, reduced_formulation, multibody_formulation };
enum FrictionLaw { exact_law = 1, regularized_law };
enum SolverMethod { automatic_method = 1, adams_method, bdf_method, runge_kutta_method };

struct Row {
  const char* name;
  Type type;
  Role role;
  double start, min, max;         // of stored variables; others have no limits
  double (*read)(Reading&);       // computed variables, else null
  double (*read_rate)(Reading&);  // d/dt where the equations give it, else null: see slopes.cpp
  // The derivative of what is not linear in the forces, from the present and the rates; else null.
  double (*by_force)(const Acting& acting, const Acting& rate);
};

const Row& row_of(unsigned variable);
// (reading) => how the wheel moves, and what acts on it
Acting acting_of(Reading& reading);

// The limit that a value does not keep: "at least", "at most", "less than" or "greater than" `value`, and the format of
// its message, which takes name, value and limit. Null where the value keeps all limits.
struct Limit {
  const char *relation = nullptr, *message = nullptr;
  double value = 0;
};
Limit broken_limit(unsigned variable, double value);
// The place of the variable that has this value reference; variable_count: there is none.
unsigned variable_of(unsigned reference);

// Variables that a caller lists by their value references.
struct Listed {
  const unsigned* references;
  unsigned operator[](std::size_t k) const { return variable_of(references[k]); }
};

// Whether a variable of this type has the place.
bool is_variable(unsigned variable, Type type);

// The choice that a stored number stands for: a Formulation, FrictionLaw or SolverMethod.
inline int choice_of(double stored) { return static_cast<int>(stored); }

}  // namespace wheel
