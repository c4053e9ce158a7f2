#pragma once

#include <span>
#include <string>

#include "nerf/image/image.h"

namespace nerf {

// One line of a contact sheet. Both pictures have 3 or 4 channels and the same size.
struct ContactSheetRow {
  std::string caption;  // one line: name, PSNR, ...
  Image truth;
  Image rendering;
};

// Truth, rendering and their difference (ColorizeError) side by side, one row for each pair, on
// white. At most 2000 pixels wide; larger pictures are reduced by a whole factor. Captions are
// above their rows, and omitted if no font is found (HasFont).
//   returns  3 channels, sRGB; an empty image if there are no rows
// Throws InputError if the pictures of a row differ in size.
Image ContactSheet(std::span<const ContactSheetRow> rows);

}  // namespace nerf
