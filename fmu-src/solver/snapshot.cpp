// stub
#include "solver.hpp"
