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

// Truth, rendering and their difference (ColorizeError) side by side, a row a picture, on white; no
// wider than 2000 pixels: larger pictures are reduced by a whole factor. Captions stand above
// their row where a common font is installed (DejaVu Sans, Liberation Sans, Arial), else they are
// left out.
//   returns  3 channels, sRGB; without rows an empty image
// Throws InputError where the pictures of a row differ in size.
Image ContactSheet(std::span<const ContactSheetRow> rows);

}  // namespace nerf
