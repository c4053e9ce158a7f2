#include "nerf/base/input_error.h"

#include <algorithm>
#include <cstddef>
#include <string_view>

namespace nerf {
namespace {

// The length of the UTF-8 character at the beginning of a text; 0 if there is none.
std::size_t CharacterLength(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  std::size_t length = 1;
  if (byte(0) >= 0x80) length = byte(0) >= 0xf0 ? 4 : byte(0) >= 0xe0 ? 3 : 2;
  if ((byte(0) >= 0x80 && byte(0) < 0xc2) || byte(0) > 0xf4 || length > text.size()) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xc0) != 0x80) return 0;
  }
  return length;
}

// The text with '?' for each byte that is not UTF-8.
std::string ValidUtf8(const std::string& text) {
  std::string valid;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = CharacterLength(std::string_view(text).substr(i));
    valid += length > 0 ? text.substr(i, length) : "?";
    i += std::max<std::size_t>(1, length);
  }
  return valid;
}

}  // namespace

std::string InputError::OneLine(std::string message) {
  message = ValidUtf8(message);
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
