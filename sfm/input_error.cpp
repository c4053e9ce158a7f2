#include "sfm/input_error.h"

#include <algorithm>

namespace sfm {

std::string InputError::OneLine(std::string message) {
  constexpr std::size_t kLongest = 2000;
  std::ranges::replace_if(
      message, [](unsigned char c) { return c < 0x20 || c == 0x7f; }, ' ');
  if (message.size() > kLongest) message = message.substr(0, kLongest) + "...";
  return message;
}

}  // namespace sfm
