#pragma once

#include <string>

#include "nerf/image/image.h"

namespace nerf {

enum class TextAlign { kLeft, kCenter, kRight };

// Whether a common font is installed (DejaVu Sans, Liberation Sans, Arial).
bool CanLetter();

// Writes one line of black text into an image with 3 channels; nothing where there is no font.
//   x, baseline  pixels; `align` says which end of the text x is
//   size         of the font, pixels
void WriteText(const std::string& text, int x, int baseline, int size, Image& image,
               TextAlign align = TextAlign::kLeft);

}  // namespace nerf
