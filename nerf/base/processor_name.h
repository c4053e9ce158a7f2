#pragma once

#include <string>

namespace nerf {

// What the processor calls itself, "AMD EPYC ..."; "unknown processor" where the system does not
// tell.
std::string ProcessorName();

}  // namespace nerf
