// The live instances of this library: a master may terminate or free an instance twice, or after it is gone.
#pragma once

namespace fmi {

// False if memory is short.
bool remember_instance(const void* instance);
bool is_live_instance(const void* instance);
// False if it was not live.
bool forget_instance(const void* instance);

}  // namespace fmi
