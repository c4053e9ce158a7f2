#pragma once

#include <spdlog/fmt/fmt.h>

#include <stdexcept>
#include <string>
#include <utility>

namespace nerf {

// An error in the user's input: a file, a key, a flag. The message is one line that names the file,
// the key and the fix. `main` prints it and exits with status 2. Since names and values in it may
// come from hostile files, control characters are replaced by spaces, bytes that are not
// UTF-8 by '?', and long messages are shortened.
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
