// What every measurement is given, and the measurements of the search for events (falls.cpp).
#pragma once

#include "problems.hpp"

struct Arguments {
  solver::Method method;
  double a, b;
};

struct Started : solver::Solver {
  Started(Case& c, solver::Method method) { start(c.problem(), method, 0, c.y.data()); }
};

void dip(const Arguments& args);
void double_dip(const Arguments& args);
void dips(const Arguments& args);
void later_piece(const Arguments& args);
void dip_beside_a_fall(const Arguments& args);
void one_step(const Arguments& args);
void release(const Arguments& args);
