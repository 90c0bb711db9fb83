// Model exchange. The caller's solver moves the states x (wheel_equations.h), from which y follows. An input acts from
// the instant at which it is set. The mode of rolling (law.hpp) is decided anew in event mode, and where a state by
// itself or the road is set; not for the states that a solver tries.
#pragma once

#include "wheel.hpp"

namespace wheel {

inline constexpr int state_count = WHEEL_EULER_STATES;
// One for each event of the table that can occur in model exchange.
int indicator_count();
// (variable) => its place in x, or -1
int place_in_x(unsigned variable);
// (place in x) => that of the state of y to which it belongs, and with it its scale
int place_in_y(int in_x);

// Inputs and road that were set are in force at once. The mode is decided in event mode; elsewhere at once, but only
// where the road has changed.
void act_at_once(Wheel& wheel);
// To event mode or continuous-time mode.
void enter_mode(Wheel& wheel, Phase phase);
// (time: s, the caller's)
void set_time(Wheel& wheel, double time);
// The states that a solver tries: no event, nothing is decided or logged.
void try_states(Wheel& wheel, const double* x);
// A variable that is a state is set by itself: the mode is decided for it, and nothing is logged.
void impose_state(Wheel& wheel, unsigned variable, double value);

// Out: state_count numbers, or indicator_count() margins. A solver may try states beyond flat: there rates and margins,
// but for that of lying flat, are those of the flat wheel, which are finite. Evaluations are counted.
void read_states(const Wheel& wheel, double* x);
void read_nominals(const Wheel& wheel, double* x);
void read_derivatives(Wheel& wheel, double* x_dot);
void read_indicators(Wheel& wheel, double* z);
bool has_event(Wheel& wheel);

// Event mode decides the mode that holds from here on. True where the motion bends here, by a state, the mode or the
// side of the ground: some solvers go on from a step that they took in the old mode, unless they read that the states
// are new. Where the model ends here, the run ends.
bool decide_in_event_mode(Wheel& wheel);

// Whether a run can begin; if not, a message is logged. Model exchange has no way to report an end at the start.
bool starts_inside(const Wheel& wheel);

}  // namespace wheel
