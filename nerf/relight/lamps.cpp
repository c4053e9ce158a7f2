#include "nerf/relight/lamps.h"

#include <algorithm>

#include "nerf/base/parallel.h"

namespace nerf {
namespace {

// Lamps are at least so far away, in units of the frame: in one, its light would be infinite.
constexpr double kLeastDistance = 1e-4;

void CopyTo(torch::Tensor row, const Eigen::Array3d& values) {
  for (int c = 0; c < 3; ++c) row[c] = values[c];
}

}  // namespace

LampTable::LampTable(const std::vector<std::vector<Lamp>>& of_groups) {
  const auto groups = static_cast<std::int64_t>(of_groups.size());
  for (const auto& own : of_groups) most_ = std::max<std::int64_t>(most_, std::ssize(own));
  place_ = torch::zeros({groups, most_, 3});
  is_sun_ = torch::ones({groups, most_});
  power_ = torch::zeros({groups, most_, 3});
  for (std::int64_t g = 0; g < groups; ++g) {
    for (std::int64_t k = 0; k < most_; ++k) {
      const auto& own = of_groups[static_cast<std::size_t>(g)];
      if (k >= std::ssize(own)) {
        CopyTo(place_[g][k], {0, 0, 1});
        continue;
      }
      const Lamp& lamp = own[static_cast<std::size_t>(k)];
      if (const auto* sun = std::get_if<DirectionalLight>(&lamp)) {
        CopyTo(place_[g][k], sun->to_light.array());
        CopyTo(power_[g][k], sun->irradiance);
      } else {
        const auto& point = std::get<PointLight>(lamp);
        CopyTo(place_[g][k], point.x_in_world.array());
        CopyTo(power_[g][k], point.intensity);
        is_sun_[g][k] = 0;
      }
    }
  }
}

LampLight LampTable::At(const torch::Tensor& positions, const torch::Tensor& group,
                        std::int64_t index) const {
  const auto of_points = [&](const torch::Tensor& table) {
    return table.select(1, index).to(positions.scalar_type()).index_select(0, group);
  };
  const torch::Tensor place = of_points(place_), power = of_points(power_);
  const torch::Tensor is_sun = of_points(is_sun_).unsqueeze(1);
  const torch::Tensor towards = place - positions * (1 - is_sun);
  const torch::Tensor distance = towards.norm(2, 1, true).clamp_min(kLeastDistance);
  return {towards / distance, power / (is_sun + (1 - is_sun) * distance.square())};
}

torch::Tensor LampTable::Visibility(const torch::Tensor& positions, const torch::Tensor& normals,
                                    const torch::Tensor& group, const MeshRays& rays,
                                    float offset) const {
  const std::int64_t points = positions.size(0);
  torch::Tensor visible = torch::empty({points, most_});
  const torch::Tensor origins = (positions + offset * normals).contiguous();
  for (std::int64_t k = 0; k < most_; ++k) {
    const torch::Tensor to_light = At(positions, group, k).to_light.contiguous();
    const torch::Tensor is_sun = is_sun_.select(1, k).index_select(0, group).contiguous();
    const torch::Tensor reach = (place_.select(1, k).index_select(0, group) - origins).norm(2, 1);
    ParallelForEach(points, [&](std::int64_t p) {
      const Eigen::Vector3f origin(origins.data_ptr<float>() + 3 * p);
      const auto hit = rays.FirstHit(origin, Eigen::Vector3f(to_light.data_ptr<float>() + 3 * p));
      const bool is_beyond =
          hit && is_sun.data_ptr<float>()[p] == 0 && hit->distance > reach.data_ptr<float>()[p];
      visible.data_ptr<float>()[p * most_ + k] = !hit || is_beyond ? 1 : 0;
    });
  }
  return visible;
}

}  // namespace nerf
