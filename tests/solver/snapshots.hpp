// What a restored solver does, and which forged histories it takes.
#pragma once

#include "problem.hpp"

// Saved after `steps` steps and restored elsewhere: whether both go on with the same bits.
void measure_snapshots(solver::Method method, int steps);

// Every word of a history replaced by numbers of all kinds: how many are refused, and that all others can be stepped.
void measure_forgeries(solver::Method method);
