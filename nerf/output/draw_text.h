#pragma once

#include <string>

#include "nerf/image/image.h"

namespace nerf {

enum class TextAlign { kLeft, kCenter, kRight };

// Whether a common font is installed (DejaVu Sans, Liberation Sans, Arial).
bool HasFont();

// Draws one line of black text into an image with 3 channels; does nothing if there is no font.
//   x, baseline  pixels; `align` is the point of the text that is at x
//   size         of the font, pixels
void DrawText(const std::string& text, int x, int baseline, int size, Image& image,
              TextAlign align = TextAlign::kLeft);

}  // namespace nerf
