#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "nerf/image/color.h"
#include "nerf/image/image.h"

namespace nerf {

// Light from all directions, infinitely far away: radiance in a latitude-longitude picture, twice
// as wide as high. The top row is straight up (+y), the middle of the picture straight ahead (-z),
// +x lies right of it. Each pixel has one radiance over its whole patch of the sphere, so that sums
// over pixels are integrals without error.
class EnvironmentMap {
 public:
  // Reads an HDR or EXR file (or any image, made linear). Throws InputError naming the file:
  // not twice as wide as high, a value that is negative or no number.
  static EnvironmentMap Read(const std::filesystem::path& file);

  // The same from all sides.
  static EnvironmentMap Uniform(const Color& radiance);

  // name  for messages. Throws InputError as Read does.
  EnvironmentMap(Image radiance, const std::string& name);

  int width() const { return radiance_.width; }
  int height() const { return radiance_.height; }
  Color At(int x, int y) const;
  // Towards the middle of a pixel; unit.
  Eigen::Vector3d Direction(int x, int y) const;
  // Of one pixel of a row, sr; a row's pixels are alike and all together make 4 pi.
  double SolidAngle(int y) const;

  Color Radiance(const Eigen::Vector3d& direction) const;

  // A direction drawn in proportion to luminance.
  struct Sample {
    Eigen::Vector3d direction;  // unit
    Color radiance;
    double pdf = 0;  // 1 / sr
  };
  //   u        uniform in [0,1)^2
  //   returns  nullopt where the map is black
  std::optional<Sample> Draw(const Eigen::Array2d& u) const;
  double Pdf(const Eigen::Vector3d& direction) const;

  // The full integral of L cos over the hemisphere about a normal: W / m^2. Slow, exact to the
  // variation of the cosine over a pixel.
  Color Irradiance(const Eigen::Vector3d& normal) const;

 private:
  struct Texel {
    int x, y;
  };
  Texel TexelOf(const Eigen::Vector3d& direction) const;

  Image radiance_;
  std::vector<double> rows_;     // cumulative power of rows [height + 1], W / m^2 sr times sr
  std::vector<double> columns_;  // cumulative within each row [height][width + 1]
};

}  // namespace nerf
