#pragma once

#include <atomic>

namespace nerf {

// From here on Ctrl-C and SIGTERM set the returned flag instead of ending the program; a second
// signal ends it.
const std::atomic<bool>& StopOnInterrupt();

}  // namespace nerf
