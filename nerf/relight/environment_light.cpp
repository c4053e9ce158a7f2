#include "nerf/relight/environment_light.h"

#include <Eigen/Geometry>
#include <numbers>
#include <vector>

#include "nerf/base/parallel.h"
#include "nerf/relight/light_transport.h"

namespace nerf {

Eigen::Matrix3d MapFromZUpWorld() {
  Eigen::Matrix3d map_from_world;
  map_from_world << 0, -1, 0,  //
      0, 0, 1,                 //
      -1, 0, 0;
  return map_from_world;
}

Eigen::Matrix3d MapFromFrame(const Eigen::Matrix3d& frame_from_input) {
  constexpr double kUpright = 0.94;  // cosine of 20 degrees
  if (frame_from_input(2, 2) < kUpright) return MapFromZUpWorld();
  return MapFromZUpWorld() * frame_from_input.transpose();
}

Eigen::Matrix3d TurnedMap(const Eigen::Matrix3d& frame_from_input, double degrees) {
  const double angle = -degrees * std::numbers::pi / 180;
  return Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitY()).toRotationMatrix() *
         MapFromFrame(frame_from_input);
}

Image EnvironmentImage(const torch::Tensor& radiance, int height,
                       const Eigen::Matrix3d& map_from_directions) {
  const std::int64_t count = radiance.size(0);
  const torch::Tensor directions = LightDirections(static_cast<int>(count));
  // Weights that fall to a third at the distance of neighbouring directions.
  const double sharpness = static_cast<double>(count) / (4 * std::numbers::pi) * 2;
  Image image(2 * height, height, 3, ColorEncoding::kLinear);
  const EnvironmentMap axes(Image(2 * height, height, 3, ColorEncoding::kLinear), "");
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < 2 * height; ++x) {
      const Eigen::Vector3f towards =
          (map_from_directions.transpose() * axes.Direction(x, y)).cast<float>();
      const torch::Tensor cosine =
          torch::matmul(directions, torch::tensor({towards.x(), towards.y(), towards.z()}));
      const torch::Tensor weight = torch::softmax(sharpness * cosine, 0);
      const torch::Tensor sum = torch::matmul(weight, radiance.detach());
      for (int c = 0; c < 3; ++c) image.At(x, y)[c] = sum[c].item<float>();
    }
  }
  return image;
}

torch::Tensor RadianceFrom(const EnvironmentMap& map, const torch::Tensor& directions,
                           const Eigen::Matrix3d& map_from_directions) {
  const std::int64_t count = directions.size(0);
  Eigen::Matrix3Xf in_map(3, count);
  for (std::int64_t d = 0; d < count; ++d) {
    const Eigen::Map<const Eigen::Vector3f> direction(directions.data_ptr<float>() + 3 * d);
    in_map.col(d) = (map_from_directions * direction.cast<double>()).cast<float>();
  }
  // Rows of texels on all threads; then their sums one after the other, so that the result does not
  // depend on the threads.
  std::vector<Eigen::Matrix4Xd> of_rows(static_cast<std::size_t>(map.height()));
  ParallelForEach(map.height(), [&](std::int64_t y) {
    Eigen::Matrix4Xd& sums = of_rows[static_cast<std::size_t>(y)];
    sums.setZero(4, count);
    const double solid_angle = map.SolidAngle(static_cast<int>(y));
    for (int x = 0; x < map.width(); ++x) {
      const Eigen::Vector3f towards = map.Direction(x, static_cast<int>(y)).cast<float>();
      Eigen::Index nearest = 0;
      (towards.transpose() * in_map).maxCoeff(&nearest);
      sums.col(nearest).head<3>() += solid_angle * map.At(x, static_cast<int>(y)).matrix();
      sums(3, nearest) += solid_angle;
    }
  });
  Eigen::Matrix4Xd sums = Eigen::Matrix4Xd::Zero(4, count);
  for (const Eigen::Matrix4Xd& row : of_rows) sums += row;
  torch::Tensor radiance = torch::empty({count, 3});
  for (std::int64_t d = 0; d < count; ++d) {
    for (int c = 0; c < 3; ++c) {
      // A direction to which no texel is nearest: more directions than texels.
      const Eigen::Vector3d centre = in_map.col(d).cast<double>();
      radiance[d][c] = sums(3, d) > 0 ? sums(c, d) / sums(3, d) : map.Radiance(centre)[c];
    }
  }
  return radiance;
}

}  // namespace nerf
