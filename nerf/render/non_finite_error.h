#pragma once

#include <stdexcept>
#include <string>

namespace nerf {

// A non-finite value in training. The message names the step, the ray and the stage.
class NonFiniteError : public std::runtime_error {
 public:
  explicit NonFiniteError(const std::string& message) : std::runtime_error(message) {}
};

}  // namespace nerf
