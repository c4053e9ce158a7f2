#include "nerf/capture/chrome_ball.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "nerf/base/input_error.h"

namespace nerf {
namespace {

using Eigen::Vector2d;
using Eigen::Vector2i;
using Eigen::Vector3d;

constexpr double kSmallestRadius = 5;    // pixels
constexpr double kLeastRoundness = 0.9;  // area of the mask over that of a disc as wide
constexpr float kHighlightShare = 0.5f;  // of the brightest pixel
constexpr float kStandsOut = 4;          // brightest pixel over the mean of the ball

float Brightness(const float* pixel) { return (pixel[0] + pixel[1] + pixel[2]) / 3; }

bool Inside(const BallOutline& ball, int x, int y) {
  return (Vector2d(x + 0.5, y + 0.5) - ball.center).norm() <= ball.radius;
}

// Centre of mass of the pixels around `peak` that are brighter than a threshold and joined to it:
// a second light's reflection or a lit table below the ball does not count.
Vector2d CenterOfSpot(const Image& photo, const BallOutline& ball, const Vector2i& peak) {
  const float threshold = kHighlightShare * Brightness(photo.At(peak.x(), peak.y()));
  std::vector<char> seen(static_cast<std::size_t>(photo.width) * photo.height, 0);
  std::vector<Vector2i> open = {peak};
  Vector2d sum = Vector2d::Zero();
  double weight = 0;
  while (!open.empty()) {
    const Vector2i at = open.back();
    open.pop_back();
    if (at.x() < 0 || at.y() < 0 || at.x() >= photo.width || at.y() >= photo.height) continue;
    char& mark = seen[static_cast<std::size_t>(at.y()) * photo.width + at.x()];
    const float brightness = Brightness(photo.At(at.x(), at.y()));
    if (mark || brightness < threshold || !Inside(ball, at.x(), at.y())) continue;
    mark = 1;
    sum += brightness * (at.cast<double>() + Vector2d::Constant(0.5));
    weight += brightness;
    for (const auto& step : {Vector2i(1, 0), Vector2i(-1, 0), Vector2i(0, 1), Vector2i(0, -1)}) {
      open.push_back(at + step);
    }
  }
  return sum / weight;
}

}  // namespace

BallOutline FindBall(const Image& mask, const std::string& name) {
  Vector2d sum = Vector2d::Zero();
  Vector2d lowest = Vector2d::Constant(1e9);
  Vector2d highest = Vector2d::Constant(-1e9);
  double area = 0;
  for (int y = 0; y < mask.height; ++y) {
    for (int x = 0; x < mask.width; ++x) {
      if (!(*mask.At(x, y) > 0.5f)) continue;
      sum += Vector2d(x + 0.5, y + 0.5);
      lowest = lowest.cwiseMin(Vector2d(x, y));
      highest = highest.cwiseMax(Vector2d(x + 1, y + 1));
      ++area;
    }
  }
  const double radius = std::sqrt(area / std::numbers::pi);
  if (radius < kSmallestRadius) {
    throw InputError("{}: marks {} pixels, too few for a ball; paint the ball white", name, area);
  }
  const double widest = (highest - lowest).maxCoeff() / 2;
  if (radius * radius < kLeastRoundness * widest * widest) {
    throw InputError("{}: what it marks is no disc; paint the whole ball white, nothing else",
                     name);
  }
  return {sum / area, radius};
}

Vector3d LightFromHighlight(const Image& photo, const BallOutline& ball, const std::string& name) {
  Vector2i peak(0, 0);
  float brightest = 0;
  double sum = 0;
  double area = 0;
  for (int y = 0; y < photo.height; ++y) {
    for (int x = 0; x < photo.width; ++x) {
      if (!Inside(ball, x, y)) continue;
      const float brightness = Brightness(photo.At(x, y));
      sum += brightness;
      ++area;
      if (brightness > brightest) brightest = brightness, peak = {x, y};
    }
  }
  if (!(brightest > 0) || brightest < kStandsOut * sum / area) {
    throw InputError("{}: the ball shows no highlight; photograph it with the light on", name);
  }
  const Vector2d at = (CenterOfSpot(photo, ball, peak) - ball.center) / ball.radius;
  const double r2 = std::min(1.0, at.squaredNorm());
  const Vector3d normal(at.x(), -at.y(), std::sqrt(1 - r2));
  return (2 * normal.z() * normal - Vector3d::UnitZ()).normalized();
}

}  // namespace nerf
