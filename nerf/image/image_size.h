#pragma once

#include <cmath>

namespace nerf {

// Size in pixels as stored in the file, and the EXIF orientation (1..8; 5..8 rotate by 90 degrees).
struct ImageSize {
  int width = 0;
  int height = 0;
  int orientation = 1;
};

// The size after rotation by the EXIF orientation.
inline ImageSize Upright(const ImageSize& stored) {
  if (stored.orientation < 5) return stored;
  return {stored.height, stored.width, stored.orientation};
}

// Whether a picture of one size may be a resized copy of one of the other: the aspect ratios agree
// within the rounding of both sides to whole pixels. Sizes that differ by less than a twentieth
// must have exactly the same aspect ratio: they are rather cropped than resized.
inline bool IsScaledCopy(const ImageSize& a, const ImageSize& b) {
  const double x = static_cast<double>(a.width) / b.width;
  const double y = static_cast<double>(a.height) / b.height;
  if (x == y) return true;
  constexpr double kResized = 0.05;
  if (std::fabs(x - 1) < kResized || std::fabs(y - 1) < kResized) return false;
  // Each side of the smaller picture is off by less than a pixel.
  const ImageSize& larger = x < 1 ? b : a;
  const double rounding = 1.0 / larger.width + 1.0 / larger.height;
  return x < 1 ? std::fabs(x - y) < rounding : std::fabs(1 / x - 1 / y) < rounding;
}

}  // namespace nerf
