#pragma once

#include <string>

#include "nerf/commands/choice_option.h"
#include "nerf/image/linear_image.h"

namespace nerf {

// Adds --encoding auto|srgb|linear: the encoding of the input images.
inline void AddInputEncodingOption(CLI::App& command, InputEncoding& encoding,
                                   const std::string& meaning) {
  AddChoiceOption<InputEncoding>(command, "--encoding", encoding,
                                 {{"auto", InputEncoding::kAuto},
                                  {"srgb", InputEncoding::kSrgb},
                                  {"linear", InputEncoding::kLinear}},
                                 meaning);
}

}  // namespace nerf
