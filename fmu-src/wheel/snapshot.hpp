// The complete state of a wheel as portable bytes: a header (mark, size, checksum), then numbers of 8 bytes each, then
// the solver's own history.
#pragma once

#include <cstddef>

#include "wheel.hpp"

namespace wheel {

// They write run.y.
std::size_t state_size(Wheel& wheel);
void save_state(Wheel& wheel, unsigned char* bytes);

// Null, or why the bytes could not have been saved: everything is then as it was, unless it is the solver's history
// that is wrong. foreign: they come from outside of this library, so the state itself is judged too. Writes all but the
// reporter.
const char* load_state(Wheel& wheel, const unsigned char* bytes, std::size_t size, bool foreign);

}  // namespace wheel
