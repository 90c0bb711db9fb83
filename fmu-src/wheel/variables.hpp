// The FMU's variables as one table: the row number is the value reference; modelDescription.xml repeats names, starts
// and limits (a test compares them row by row). Units and frames: docs/notation.md.
#pragma once

#include <cstddef>
#include <limits>

namespace wheel {

class Reading;

enum class Type : unsigned char { real, integer, boolean };
enum class Role : unsigned char { parameter, tunable, input, output, local };

// Value references of what the program itself names. Outputs and locals follow: a row in `variables` and an entry in
// modelDescription.xml are all that a new one needs.
enum Variable : unsigned {
  m,
  r_0,
  r,
  J_x,
  J_y,
  J_z,
  g,
  s,
  psi_start,
  theta_start,
  phi_start,
  psi_dot_start,
  theta_dot_start,
  phi_dot_start,
  X_O_start,
  Y_O_start,
  formulation,
  friction_law,
  omega_s,
  method,
  keep_contact,
  F_X,
  F_Y,
  F_Z,
  M_1,
  M_2,
  M_3,
  stored_count,  // parameters and inputs keep a value; the rest is computed on request
};

inline constexpr unsigned first_input = F_X, input_count = stored_count - F_X;

enum Formulation : int { automatic_formulation = 1, reduced_formulation, multibody_formulation };
enum FrictionLaw { exact_law = 1, regularized_law };
enum SolverMethod { automatic_method = 1, adams_method, bdf_method };

struct Row {
  const char* name;
  Type type;
  Role role;
  double start, min, max;                   // stored variables
  double (*read)(Reading&);                 // computed variables, else null
  double (*read_rate)(Reading&) = nullptr;  // d/dt of a continuous output, else null
  int reaction = none;                      // i of lambda[i], which answers an input at once; else none
  static constexpr int none = -1;
};

unsigned variable_count();
const Row& row_of(unsigned variable);
// Whether the value reference names a variable of this type.
bool is_variable(unsigned variable, Type type);

// An enumeration's value among the stored numbers.
inline int choice_of(double stored) { return static_cast<int>(stored); }

}  // namespace wheel
