#include "nerf/base/input_error.h"

#include <cstddef>

namespace nerf {

std::string InputError::OneLine(std::string message) {
  for (std::size_t i = 0; i < message.size(); ++i) {
    const auto c = static_cast<unsigned char>(message[i]);
    if (c < 0x20 || c == 0x7f) message[i] = ' ';
    // U+0080 to U+009F, which terminals interpret too.
    if (c == 0xc2 && i + 1 < message.size() && static_cast<unsigned char>(message[i + 1]) < 0xa0) {
      message[i] = message[i + 1] = ' ';
    }
  }
  // The file is named at the front and the fix at the end, so the middle is removed, between two
  // characters.
  constexpr std::size_t kFront = 1200, kEnd = 600;
  if (message.size() <= kFront + kEnd) return message;
  const auto is_inside_character = [&](std::size_t at) {
    return (static_cast<unsigned char>(message[at]) & 0xc0) == 0x80;
  };
  std::size_t front = kFront, end = message.size() - kEnd;
  while (front > 0 && is_inside_character(front)) --front;
  while (end < message.size() && is_inside_character(end)) ++end;
  return message.substr(0, front) + " ... " + message.substr(end);
}

}  // namespace nerf
