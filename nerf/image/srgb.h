#pragma once

#include <cstdint>

namespace nerf {

// The sRGB transfer function and its inverse (IEC 61966-2-1), extended beyond [0,1]: as an odd
// function below 0, and by the power law above 1.
float SrgbFromLinear(float linear);
float LinearFromSrgb(float srgb);

// An sRGB value as stored in an 8-bit file: clamped to [0,1], scaled to [0,255], rounded half up.
// Must not be NaN.
std::uint8_t ByteFromSrgb(float srgb);

}  // namespace nerf
