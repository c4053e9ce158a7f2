#pragma once

namespace nerf {

// The most memory that this process has held so far, in units of 10^6 bytes.
double PeakMegabytes();

}  // namespace nerf
