// Model exchange. The caller's solver moves the states x (wheel_equations.h), from which y follows. An input acts from
// the instant at which it is set. The law of rolling resistance is decided anew at events, and where a state or the
// road is set.
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

// What was set is in force at once, except for the law, which is decided in event mode. Outside of event mode, another
// road asks for another law at once.
void act_at_once(Wheel& wheel);
// To event mode or continuous-time mode.
void enter(Wheel& wheel, Phase mode);
// (time: s, the caller's)
void set_time(Wheel& wheel, double time);
void set_states(Wheel& wheel, const double* x);
// Of a variable that is a state, by itself: the law of rolling resistance is decided for it. A state that is only tried
// is no event, and nothing is logged.
void set_state(Wheel& wheel, unsigned variable, double value);

// Out: state_count numbers, or indicator_count() margins. A solver may try states beyond flat: there rates and margins,
// but for that of lying flat, are those of the flat wheel, which are finite. Evaluations are counted.
void read_states(const Wheel& wheel, double* x);
void read_nominals(const Wheel& wheel, double* x);
void read_derivatives(Wheel& wheel, double* x_dot);
void read_indicators(Wheel& wheel, double* z);
bool has_event(Wheel& wheel);

// Event mode decides the law that holds from here on. True where the motion bends here, by a state or by the law: some
// solvers go on from a step that they took under the old law, unless they read that the states are new. Where the model
// ends here, the run ends.
bool decide_in_event_mode(Wheel& wheel);

// Whether a run can begin; if not, a message is logged. Model exchange has no way to report an end at the start.
bool starts_inside(const Wheel& wheel);

}  // namespace wheel
