#pragma once

namespace nerf {

// Sets the number of threads; 0: all cores available to this process. Returns the number.
// Throws InputError if it is negative.
int UseThreads(int threads);

}  // namespace nerf
