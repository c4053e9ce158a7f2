#pragma once

#include <spdlog/fmt/fmt.h>

#include <stdexcept>
#include <string>
#include <utility>

namespace nerf {

// Something that a person gave us is wrong: a file, a key, a flag. The message is one line that
// names the file, the key and the mend. `main` prints it and exits with status 2. Names and values
// in it come from hostile files too: control characters become spaces, what is too long is cut.
class InputError : public std::runtime_error {
 public:
  explicit InputError(const std::string& message) : std::runtime_error(OneLine(message)) {}

  template <class... Args>
  explicit InputError(fmt::format_string<Args...> format, Args&&... args)
      : InputError(fmt::format(format, std::forward<Args>(args)...)) {}

 private:
  static std::string OneLine(std::string message);
};

}  // namespace nerf
