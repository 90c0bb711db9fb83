// Whether parameters and inputs describe a wheel, and a state is one of it.
#pragma once

#include "demand.hpp"
#include "reading.hpp"
#include "reporter.hpp"

namespace wheel {

// rad: a larger angle has too few digits for a heading.
inline constexpr double largest_angle = 1e12;

// Logs one message per fault; true if there is none.
bool check_values(const Demand& demand, const Reporter& reporter);

// Whether the wheel stands, and its energy and reactions are finite.
bool is_inside(Reading& now);

// The same of the initial state, with a message: values that are sound one by one can have products that are not
// finite.
bool check_start(const Demand& demand, Reading& start, const Reporter& reporter);

}  // namespace wheel
