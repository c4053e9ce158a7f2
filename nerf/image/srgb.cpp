#include "nerf/image/srgb.h"

#include <algorithm>
#include <cmath>

namespace nerf {
namespace {

float SrgbFromPositive(float x) {
  return x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1.0f / 2.4f) - 0.055f;
}

float LinearFromPositive(float x) {
  return x <= 0.04045f ? x / 12.92f : std::pow((x + 0.055f) / 1.055f, 2.4f);
}

}  // namespace

float SrgbFromLinear(float linear) {
  return std::copysign(SrgbFromPositive(std::abs(linear)), linear);
}

float LinearFromSrgb(float srgb) { return std::copysign(LinearFromPositive(std::abs(srgb)), srgb); }

std::uint8_t ByteFromSrgb(float srgb) {
  return static_cast<std::uint8_t>(std::clamp(srgb, 0.0f, 1.0f) * 255.0f + 0.5f);
}

}  // namespace nerf
