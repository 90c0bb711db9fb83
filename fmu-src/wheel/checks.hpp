// Whether parameters and inputs describe a wheel, and a state is one of it.
#pragma once

#include "demand.hpp"
#include "reading.hpp"
#include "reporter.hpp"

namespace wheel {

// rad: the digits of a larger angle do not tell where the wheel points.
inline constexpr double largest_angle = 1e12;

// Tells one sentence per fault; true if there is none.
bool check_values(const Demand& demand, const Reporter& reporter);

// Whether the wheel stands, and its energy and reactions are finite.
bool is_inside(Reading& now);

}  // namespace wheel
