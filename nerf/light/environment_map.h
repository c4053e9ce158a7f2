#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "nerf/image/color.h"
#include "nerf/image/image.h"

namespace nerf {

// Distant illumination: radiance as a function of the direction, stored as a latitude-longitude
// image, twice as wide as high. The top row is straight up (+y), the centre of the image is
// straight ahead (-z), and +x is to the right of it. Radiance is constant over the solid angle of a
// pixel, so that sums over pixels are exact integrals.
class EnvironmentMap {
 public:
  // Reads an HDR or EXR file, or any other image, converted to linear light. Throws InputError
  // naming the file if the image is not twice as wide as high, or a value is not finite or
  // negative. Slightly negative values, as resampling leaves, are replaced by the darkest of
  // their neighbours, with a warning.
  static EnvironmentMap Read(const std::filesystem::path& file);

  // The same radiance from all directions.
  static EnvironmentMap Uniform(const Color& radiance);

  //   name  for error messages
  // Throws InputError as Read does.
  EnvironmentMap(Image radiance, const std::string& name);

  int width() const { return radiance_.width; }
  int height() const { return radiance_.height; }
  Color At(int x, int y) const;
  // The direction of the centre of a pixel; unit.
  Eigen::Vector3d Direction(int x, int y) const;
  // The solid angle of each pixel of a row, sr; those of all pixels sum to 4 pi.
  double SolidAngle(int y) const;

  Color Radiance(const Eigen::Vector3d& direction) const;

  // A direction drawn with a density proportional to the luminance.
  struct DirectionSample {
    Eigen::Vector3d direction;  // unit
    Color radiance;
    double pdf = 0;  // 1 / sr
  };
  //   u        uniform in [0,1)^2
  //   returns  nullopt if the map is black
  std::optional<DirectionSample> Sample(const Eigen::Array2d& u) const;
  // The density of Sample, 1 / sr.
  double Pdf(const Eigen::Vector3d& direction) const;

  // Irradiance on a surface with this normal, the integral of L cos over its hemisphere, W / m^2.
  // Sums all pixels; exact except for the variation of the cosine within a pixel.
  Color Irradiance(const Eigen::Vector3d& normal) const;

 private:
  struct Texel {
    int x, y;
  };
  Texel TexelOf(const Eigen::Vector3d& direction) const;

  Image radiance_;
  std::vector<double> rows_;     // cumulative power of the rows, [height + 1]
  std::vector<double> columns_;  // cumulative luminance within each row, [height][width + 1]
};

}  // namespace nerf
