// Whether parameters and inputs describe a wheel, and a state is one of it.
#pragma once

#include "demand.hpp"
#include "reading.hpp"

namespace wheel {

// rad: the digits of a larger angle do not tell where the wheel points.
inline constexpr double largest_angle = 1e12;

// One sentence per fault goes to `tell` (null: nowhere); true if there is none.
bool check_values(const Demand& demand, void* owner, void (*tell)(void* owner, const char* sentence));

// Whether the wheel stands, and its energy and reactions are finite.
bool is_inside(Reading& now);

}  // namespace wheel
