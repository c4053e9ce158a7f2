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

constexpr double kMinRadius = 5;             // pixels
constexpr double kMinRoundness = 0.9;        // area of the mask over that of a disc of its width
constexpr float kHighlightThreshold = 0.5f;  // relative to the brightest pixel
constexpr float kMinContrast = 4;            // brightest pixel over the mean of the ball

float Brightness(const float* pixel) { return (pixel[0] + pixel[1] + pixel[2]) / 3; }

bool Inside(const BallOutline& ball, int x, int y) {
  return (Vector2d(x + 0.5, y + 0.5) - ball.center).norm() <= ball.radius;
}

// Centre of mass of the connected bright region around `peak`; the reflections of other lights or
// of a lit table are not part of it.
Vector2d HighlightCenter(const Image& photo, const BallOutline& ball, const Vector2i& peak) {
  const float threshold = kHighlightThreshold * Brightness(photo.At(peak.x(), peak.y()));
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
  if (radius < kMinRadius) {
    throw InputError("{}: the mask has {} white pixels, too few for a ball; paint the ball white",
                     name, area);
  }
  const double widest = (highest - lowest).maxCoeff() / 2;
  if (radius * radius < kMinRoundness * widest * widest) {
    throw InputError("{}: the mask is not a disc; paint the whole ball white, and nothing else",
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
  if (!(brightest > 0) || brightest < kMinContrast * sum / area) {
    throw InputError("{}: no highlight on the ball; photograph it with the light on", name);
  }
  const Vector2d at = (HighlightCenter(photo, ball, peak) - ball.center) / ball.radius;
  const double r2 = std::min(1.0, at.squaredNorm());
  const Vector3d normal(at.x(), -at.y(), std::sqrt(1 - r2));
  return (2 * normal.z() * normal - Vector3d::UnitZ()).normalized();
}

}  // namespace nerf
