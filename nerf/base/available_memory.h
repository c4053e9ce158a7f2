#pragma once

namespace nerf {

// Memory that this process can still use, in units of 10^6 bytes: what the system has free or can
// free, and what a container leaves. Infinite where the system does not tell.
double AvailableMegabytes();

}  // namespace nerf
