#pragma once

#include <string>

namespace nerf {

// The model name of the processor, "AMD EPYC ..."; "unknown processor" where the system has none.
std::string ProcessorName();

}  // namespace nerf
