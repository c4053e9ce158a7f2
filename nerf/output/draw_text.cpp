#include "nerf/output/draw_text.h"

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

#include <array>

namespace nerf {
namespace {

// The first installed font that OpenImageIO can load; empty: none.
std::string FindFont() {
  for (const char* name : {"DejaVuSans", "LiberationSans-Regular", "Arial"}) {
    OIIO::ImageBuf trial(OIIO::ImageSpec(8, 8, 3, OIIO::TypeFloat));
    if (OIIO::ImageBufAlgo::render_text(trial, 0, 4, "a", 8, name)) return name;
  }
  return "";
}

const std::string& Font() {
  static const std::string font = FindFont();
  return font;
}

}  // namespace

bool HasFont() { return !Font().empty(); }

void DrawText(const std::string& text, int x, int baseline, int size, Image& image,
              TextAlign align) {
  if (!HasFont()) return;
  using OIIO::ImageBufAlgo::TextAlignX;
  const TextAlignX align_x = align == TextAlign::kLeft     ? TextAlignX::Left
                             : align == TextAlign::kCenter ? TextAlignX::Center
                                                           : TextAlignX::Right;
  OIIO::ImageBuf canvas(OIIO::ImageSpec(image.width, image.height, image.channels, OIIO::TypeFloat),
                        image.pixels.data());
  const std::array<float, 3> black = {0, 0, 0};
  OIIO::ImageBufAlgo::render_text(canvas, x, baseline, text, size, Font(), black, align_x);
}

}  // namespace nerf
