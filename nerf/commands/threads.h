#pragma once

namespace nerf {

// Uses `threads` threads, or all cores that this process may use when it is 0. Returns the number.
// Throws InputError when it is negative.
int UseThreads(int threads);

}  // namespace nerf
