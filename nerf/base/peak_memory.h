#pragma once

namespace nerf {

// The peak resident memory of this process so far, in units of 10^6 bytes.
double PeakMegabytes();

}  // namespace nerf
