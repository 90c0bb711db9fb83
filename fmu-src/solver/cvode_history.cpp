// stub
#include "cvode_engine.hpp"
