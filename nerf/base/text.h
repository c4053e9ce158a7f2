#pragma once

#include <algorithm>
#include <cctype>
#include <string>

namespace nerf {

// The text with A to Z in lower case, in any locale.
inline std::string Lowercase(std::string text) {
  std::ranges::transform(text, text.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

// The text without the byte order mark that Windows puts before UTF-8.
inline std::string WithoutBom(std::string text) {
  if (text.starts_with("\xef\xbb\xbf")) text.erase(0, 3);
  return text;
}

// The first line of a text.
inline std::string FirstLine(const std::string& text) { return text.substr(0, text.find('\n')); }

}  // namespace nerf
