// The caller's way to a run: what is set, checked and begun.
#pragma once

#include "wheel.hpp"

namespace wheel {

// The wheel is as new: start values, and no state. The orbit is kept for the next run with the same key.
void reset(Wheel& wheel);
// stop_time: infinite for none. tolerance <= 0: the default one.
void set_experiment(Wheel& wheel, double start_time, double stop_time, double tolerance);
// Sets a parameter, or an input or its derivative; in a run of model exchange a state too. Parameters are checked as a
// whole by `prepare`.
void set(Wheel& wheel, unsigned variable, double value, int order = 0);
// The parameters are checked from here on.
void begin_initialization(Wheel& wheel);
// Computes the initial state from the present parameters. If there is none, false, with one message per fault.
bool prepare(Record& record, const Reporter& reporter);
// `prepare` where the parameters have changed since it was last done, so that reading several values logs their faults
// once. False as long as they are faulty; true where no initial state is due.
bool prepare_once(Wheel& wheel);
// The run can begin; false if there is no initial state, with all faults, even if they were logged before.
bool end_initialization(Wheel& wheel);

}  // namespace wheel
