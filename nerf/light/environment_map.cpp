#include "nerf/light/environment_map.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "nerf/base/input_error.h"
#include "nerf/image/linear_image.h"

namespace nerf {
namespace {

using Eigen::Vector3d;

using std::numbers::pi;

// The share of the light that negative values may have where a map was resampled, with a filter
// that overshoots.
constexpr double kResampling = 1e-3;

void CheckRadiance(const Image& image, const std::string& name) {
  if (image.width != 2 * image.height || image.height < 1) {
    throw InputError("{}: {} x {} pixels; an environment map must be twice as wide as high", name,
                     image.width, image.height);
  }
  double light = 0, negative = 0;
  for (const float value : image.pixels) (value < 0 ? negative : light) += std::fabs(value);
  const bool resampled = negative <= kResampling * light;
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const float value = image.pixels[i];
    if (std::isfinite(value) && (value >= 0 || resampled)) continue;
    const auto pixel = static_cast<int>(i / 3);
    throw InputError(
        "{}: the value at pixel ({}, {}) is {}; radiance must be finite and not negative", name,
        pixel % image.width, pixel / image.width, value);
  }
}

// The darkest of the values around (x, y) that are not negative; 0 if there are none.
float DarkestNeighbour(const Image& image, int x, int y, int c) {
  float darkest = std::numeric_limits<float>::infinity();
  for (int v = std::max(0, y - 1); v <= std::min(image.height - 1, y + 1); ++v) {
    for (const int u : {(x + image.width - 1) % image.width, x, (x + 1) % image.width}) {
      const float value = image.At(u, v)[c];
      if (value >= 0) darkest = std::min(darkest, value);
    }
  }
  return std::isfinite(darkest) ? darkest : 0;
}

// Slightly negative values are the overshoot of a resampling filter, on the dark side of an edge:
// the dark side is what should be there.
void ReplaceNegative(Image& image, const std::string& name) {
  const Image before = image;
  int replaced = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      for (int c = 0; c < 3; ++c) {
        if (before.At(x, y)[c] >= 0) continue;
        image.At(x, y)[c] = DarkestNeighbour(before, x, y, c);
        ++replaced;
      }
    }
  }
  if (replaced == 0) return;
  spdlog::warn(
      "{}: {} values are slightly negative, as after resampling; they are replaced by the darkest "
      "of "
      "their neighbours",
      name, replaced);
}

// The bin of a piecewise constant distribution that u selects, and the position in it, in [0,1].
//   cumulative  sums of the weights of the bins, [bins + 1]
struct Selection {
  int bin;
  double within;
};
Selection SelectBin(const double* cumulative, int bins, double u) {
  const double target = u * cumulative[bins];
  const double* above = std::upper_bound(cumulative + 1, cumulative + bins, target);
  auto bin = static_cast<int>(above - cumulative) - 1;
  // u just below 1 may be rounded to the end, where bins can be empty.
  while (bin > 0 && cumulative[bin + 1] == cumulative[bin]) --bin;
  const double weight = cumulative[bin + 1] - cumulative[bin];
  return {bin, weight > 0 ? std::clamp((target - cumulative[bin]) / weight, 0.0, 1.0) : 0.5};
}

}  // namespace

EnvironmentMap EnvironmentMap::Read(const std::filesystem::path& file) {
  return {ReadLinearImage(file, InputEncoding::kAuto), file.string()};
}

EnvironmentMap EnvironmentMap::Uniform(const Color& radiance) {
  Image image(64, 32, 3, ColorEncoding::kLinear);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    image.pixels[i] = static_cast<float>(radiance[static_cast<int>(i % 3)]);
  }
  return {std::move(image), "uniform"};
}

EnvironmentMap::EnvironmentMap(Image radiance, const std::string& name)
    : radiance_(std::move(radiance)) {
  CheckRadiance(radiance_, name);
  ReplaceNegative(radiance_, name);
  const auto stride = static_cast<std::size_t>(width()) + 1;
  rows_.assign(static_cast<std::size_t>(height()) + 1, 0);
  columns_.assign(static_cast<std::size_t>(height()) * stride, 0);
  for (int y = 0; y < height(); ++y) {
    double* columns = &columns_[static_cast<std::size_t>(y) * stride];
    for (int x = 0; x < width(); ++x) columns[x + 1] = columns[x] + Luminance(At(x, y));
    rows_[static_cast<std::size_t>(y) + 1] =
        rows_[static_cast<std::size_t>(y)] + columns[width()] * SolidAngle(y);
  }
}

Color EnvironmentMap::At(int x, int y) const {
  const float* pixel = radiance_.At(x, y);
  return {pixel[0], pixel[1], pixel[2]};
}

Vector3d EnvironmentMap::Direction(int x, int y) const {
  const double theta = pi * (y + 0.5) / height();
  const double phi = 2 * pi * ((x + 0.5) / width() - 0.5);
  return {std::sin(theta) * std::sin(phi), std::cos(theta), -std::sin(theta) * std::cos(phi)};
}

double EnvironmentMap::SolidAngle(int y) const {
  return 2 * pi / width() * (std::cos(pi * y / height()) - std::cos(pi * (y + 1) / height()));
}

EnvironmentMap::Texel EnvironmentMap::TexelOf(const Vector3d& d) const {
  const double theta = std::atan2(std::hypot(d.x(), d.z()), d.y());
  const double turn = std::atan2(d.x(), -d.z()) / (2 * pi) + 0.5;
  return {std::clamp(static_cast<int>(turn * width()), 0, width() - 1),
          std::clamp(static_cast<int>(theta / pi * height()), 0, height() - 1)};
}

Color EnvironmentMap::Radiance(const Vector3d& direction) const {
  const auto [x, y] = TexelOf(direction);
  return At(x, y);
}

std::optional<EnvironmentMap::DirectionSample> EnvironmentMap::Sample(
    const Eigen::Array2d& u) const {
  const double power = rows_.back();
  if (!(power > 0)) return std::nullopt;
  const Selection row = SelectBin(rows_.data(), height(), u.y());
  const auto stride = static_cast<std::size_t>(width()) + 1;
  const Selection column =
      SelectBin(&columns_[static_cast<std::size_t>(row.bin) * stride], width(), u.x());
  // Uniform over the solid angle of the pixel: in phi and in cos(theta).
  const double above = std::cos(pi * row.bin / height());
  const double below = std::cos(pi * (row.bin + 1) / height());
  const double cos_theta = above + (below - above) * row.within;
  const double sin_theta = std::sqrt(std::max(0.0, 1 - cos_theta * cos_theta));
  const double phi = 2 * pi * ((column.bin + column.within) / width() - 0.5);
  const Color radiance = At(column.bin, row.bin);
  return DirectionSample{{sin_theta * std::sin(phi), cos_theta, -sin_theta * std::cos(phi)},
                         radiance,
                         Luminance(radiance) / power};
}

double EnvironmentMap::Pdf(const Vector3d& direction) const {
  return rows_.back() > 0 ? Luminance(Radiance(direction)) / rows_.back() : 0;
}

Color EnvironmentMap::Irradiance(const Vector3d& normal) const {
  Color sum = Color::Zero();
  for (int y = 0; y < height(); ++y) {
    for (int x = 0; x < width(); ++x) {
      const double cosine = normal.dot(Direction(x, y));
      if (cosine > 0) sum += At(x, y) * (cosine * SolidAngle(y));
    }
  }
  return sum;
}

}  // namespace nerf
