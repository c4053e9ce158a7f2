#pragma once

#include <atomic>

namespace nerf {

// From this call on, Ctrl-C and SIGTERM set the returned flag instead of terminating the program; a
// second signal terminates it.
const std::atomic<bool>& StopOnInterrupt();

// The same flag, without that change.
const std::atomic<bool>& StopRequested();

}  // namespace nerf
