#pragma once

#include <cstdint>

namespace nerf {

// The sRGB transfer function and its inverse (IEC 61966-2-1), on [0,1]; linear with slope 12.92
// near 0 and, as an odd function, below it; the power law goes on above 1.
float SrgbFromLinear(float linear);
float LinearFromSrgb(float srgb);

// An sRGB value as an 8-bit file stores it: clamped to [0,1], scaled to [0,255], rounded half up.
// The value must be a number.
std::uint8_t ByteFromSrgb(float srgb);

}  // namespace nerf
