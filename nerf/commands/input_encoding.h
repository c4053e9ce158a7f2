#pragma once

#include <CLI/CLI.hpp>
#include <map>
#include <string>

#include "nerf/appearance/linear_image.h"

namespace nerf {

// --encoding auto|srgb|linear: what the numbers of the given images mean.
inline void AddInputEncodingOption(CLI::App& command, appearance::InputEncoding& encoding,
                                   const std::string& meaning) {
  static const std::map<std::string, appearance::InputEncoding> encodings = {
      {"auto", appearance::InputEncoding::kAuto},
      {"srgb", appearance::InputEncoding::kSrgb},
      {"linear", appearance::InputEncoding::kLinear}};
  command.add_option("--encoding", encoding, meaning)
      ->transform(CLI::CheckedTransformer(encodings))
      ->default_str("auto");
}

}  // namespace nerf
