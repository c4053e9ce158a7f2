#include "nerf/capture/light_voronoi.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

#include "nerf/base/input_error.h"
#include "nerf/base/parallel.h"
#include "nerf/base/quantile.h"

namespace nerf {
namespace {

using Eigen::Vector3d;

using std::numbers::pi;
constexpr double kSameAngle = 1e-3;  // radians
constexpr double kReach = 2;         // of a light, relative to the median distance of neighbours
constexpr int kPixelsPerLight = 100;

double Polar(const Vector3d& d) { return std::atan2(std::hypot(d.x(), d.z()), d.y()); }
double Azimuth(const Vector3d& d) {
  const double phi = std::atan2(d.x(), -d.z());
  return phi < 0 ? phi + 2 * pi : phi;
}

// Lights in rows of equal polar angle, with the same evenly spaced azimuths in each row.
struct Grid {
  std::vector<double> theta;             // of each row, ascending
  std::vector<std::vector<int>> lights;  // [row][column], azimuth ascending from `phase`
  double phase = 0;                      // azimuth of the first column
};

std::optional<Grid> FindGrid(std::span<const DirectionalLight> lights) {
  std::map<double, std::vector<int>> rows;
  for (int i = 0; i < std::ssize(lights); ++i) {
    const double theta = Polar(lights[static_cast<std::size_t>(i)].to_light);
    auto row = rows.lower_bound(theta - kSameAngle);
    if (row == rows.end() || row->first > theta + kSameAngle) row = rows.insert({theta, {}}).first;
    row->second.push_back(i);
  }
  Grid grid;
  for (auto& [theta, row] : rows) {
    const auto azimuth = [&](int i) {
      return Azimuth(lights[static_cast<std::size_t>(i)].to_light);
    };
    std::ranges::sort(row, {}, azimuth);
    const double step = 2 * pi / static_cast<double>(row.size());
    const double first = azimuth(row.front());
    if (grid.theta.empty()) grid.phase = first;
    if (row.size() < 3 || row.size() != rows.begin()->second.size()) return std::nullopt;
    for (std::size_t c = 0; c < row.size(); ++c) {
      if (std::abs(azimuth(row[c]) - grid.phase - step * static_cast<double>(c)) > kSameAngle) {
        return std::nullopt;
      }
    }
    grid.theta.push_back(theta);
    grid.lights.push_back(row);
  }
  if (grid.theta.size() < 2) return std::nullopt;
  // The rows must be evenly spaced, with half a step to the poles, as those of pixels are;
  // otherwise the solid angles are not the sin term.
  const double step = pi / static_cast<double>(grid.theta.size());
  for (std::size_t r = 0; r < grid.theta.size(); ++r) {
    if (std::abs(grid.theta[r] - step * (static_cast<double>(r) + 0.5)) > kSameAngle) {
      return std::nullopt;
    }
  }
  return grid;
}

int LightOnGrid(const Grid& grid, const Vector3d& d) {
  const auto rows = static_cast<int>(grid.theta.size());
  const int row = std::clamp(static_cast<int>(Polar(d) / pi * rows), 0, rows - 1);
  const auto& lights = grid.lights[static_cast<std::size_t>(row)];
  const auto columns = static_cast<int>(lights.size());
  const double position = (Azimuth(d) - grid.phase) / (2 * pi) * columns;
  const int column = (static_cast<int>(std::floor(position + 0.5)) % columns + columns) % columns;
  return lights[static_cast<std::size_t>(column)];
}

// The cosine of the largest angle between a light and the directions of its cell. Coincident lights
// count as one.
float CosineOfReach(const Eigen::Matrix<float, Eigen::Dynamic, 3>& directions) {
  const auto count = static_cast<int>(directions.rows());
  std::vector<float> nearest(static_cast<std::size_t>(count), -1);
  ParallelFor(count, 16, [&](std::int64_t begin, std::int64_t end) {
    for (auto i = static_cast<int>(begin); i < static_cast<int>(end); ++i) {
      for (int j = 0; j < count; ++j) {
        if ((directions.row(i) - directions.row(j)).norm() < kSameAngle) continue;
        float& cosine = nearest[static_cast<std::size_t>(i)];
        cosine = std::max(cosine, directions.row(i).dot(directions.row(j)));
      }
    }
  });
  const double median = UpperMedian(nearest);
  const double reach = kReach * std::acos(std::clamp(median, -1.0, 1.0));
  return static_cast<float>(std::cos(std::min(reach, pi)));
}

}  // namespace

int CellRows(int lights, int map_height) {
  // There are 2 rows^2 pixels.
  const double wanted = std::sqrt(kPixelsPerLight * static_cast<double>(lights) / 2);
  return map_height * std::max(1, static_cast<int>(std::ceil(wanted / map_height)));
}

LightVoronoi::LightVoronoi(std::span<const DirectionalLight> lights, int height)
    : light_count_(static_cast<int>(lights.size())),
      height_(height),
      light_of_pixel_(static_cast<std::size_t>(height) * height * 2) {
  if (lights.empty()) throw InputError("no lights to relight with; give one for each image");
  // For the directions of its pixels; their values are not used.
  const EnvironmentMap pixels(Image(2 * height, height, 3, ColorEncoding::kLinear), "cells");
  const std::optional<Grid> grid = FindGrid(lights);
  on_a_grid_ = grid.has_value();
  Eigen::Matrix<float, Eigen::Dynamic, 3> directions(light_count_, 3);
  for (int i = 0; i < light_count_; ++i) {
    directions.row(i) = lights[static_cast<std::size_t>(i)].to_light.cast<float>();
  }
  const float min_cosine = grid ? -1.0f : CosineOfReach(directions);
  ParallelFor(height, 1, [&](std::int64_t begin, std::int64_t end) {
    Eigen::VectorXf cosines(light_count_);
    for (auto y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
      for (int x = 0; x < 2 * height; ++x) {
        const Vector3d d = pixels.Direction(x, y);
        int& light = light_of_pixel_[static_cast<std::size_t>(y) * 2 * height + x];
        if (grid) {
          light = LightOnGrid(*grid, d);
        } else {
          cosines.noalias() = directions * d.cast<float>();
          if (cosines.maxCoeff(&light) < min_cosine) light = light_count_;
        }
      }
    }
  });
}

std::vector<double> LightVoronoi::SolidAngles() const {
  Image ones(2 * height_, height_, 3, ColorEncoding::kLinear);
  std::ranges::fill(ones.pixels, 1.0f);
  std::vector<double> angles;
  for (const Color& color : Integrate({std::move(ones), "cells"})) angles.push_back(color.x());
  return angles;
}

std::vector<Color> LightVoronoi::Integrate(const EnvironmentMap& map, double degrees) const {
  std::vector<Color> sums = Sums(map, degrees);
  sums.pop_back();
  return sums;
}

double LightVoronoi::UncoveredFraction(const EnvironmentMap& map, double degrees) const {
  const std::vector<Color> sums = Sums(map, degrees);
  double power = 0;
  for (const Color& sum : sums) power += Luminance(sum);
  return power > 0 ? Luminance(sums.back()) / power : 0;
}

std::vector<Color> LightVoronoi::Sums(const EnvironmentMap& map, double degrees) const {
  std::vector<Color> sums(static_cast<std::size_t>(light_count_) + 1, Color::Zero());
  const int width = 2 * height_;
  const int repeat = height_ / map.height();  // a pixel of the map covers repeat^2 pixels here
  const int shift = static_cast<int>(std::lround(degrees / 360 * width)) % width;
  for (int y = 0; y < height_; ++y) {
    const double solid_angle =
        2 * pi / width * (std::cos(pi * y / height_) - std::cos(pi * (y + 1) / height_));
    for (int x = 0; x < width; ++x) {
      // Azimuth increases to the right, clockwise as seen from above; so a counter-clockwise
      // rotation moves the environment to the left.
      const int from = ((x + shift) % width + width) % width;
      const int light = light_of_pixel_[static_cast<std::size_t>(y) * width + x];
      sums[static_cast<std::size_t>(light)] += map.At(from / repeat, y / repeat) * solid_angle;
    }
  }
  return sums;
}

}  // namespace nerf
