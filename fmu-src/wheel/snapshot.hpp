// The complete state of a wheel as portable bytes: a header (mark, size, checksum), then numbers of 8 bytes each, then
// the solver's history.
#pragma once

#include "wheel.hpp"

namespace wheel {

std::size_t state_size(Wheel& wheel);
void save_state(Wheel& wheel, unsigned char* bytes);

// Null, or why the bytes are no state of such a wheel, or damaged: by mark, size and checksum.
const char* fault_of(Kind kind, const unsigned char* bytes, std::size_t size);
// Null, or what is wrong with the bytes: everything is then as it was, unless it is the solver's history, without which
// the run has failed.
const char* load_state(Wheel& wheel, const unsigned char* bytes, std::size_t size);

}  // namespace wheel
