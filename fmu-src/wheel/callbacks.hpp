// What the solver asks of a simulation: right-hand side, error weights, the friction event, the boundary of the model.
#pragma once

#include "integrator.hpp"

namespace wheel {

class Simulation;

integrator::System solver_system(Simulation& simulation);

}  // namespace wheel
