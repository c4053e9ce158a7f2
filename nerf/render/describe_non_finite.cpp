#include "nerf/render/describe_non_finite.h"

#include <spdlog/fmt/fmt.h>

#include <cstdint>

namespace nerf {

std::string DescribeNonFinite(const PackedSamples& samples, const FieldOutput& field,
                              const torch::Tensor& rgb, const torch::Tensor& target) {
  const auto first_bad = [](const torch::Tensor& values) {
    const torch::Tensor bad = torch::nonzero(torch::logical_not(torch::isfinite(values)));
    return bad.size(0) > 0 ? bad[0][0].item<std::int64_t>() : std::int64_t{-1};
  };
  if (const std::int64_t s = first_bad(field.sigma); s >= 0) {
    return fmt::format("ray {}, stage density, sample at t = {}", samples.ray[s], samples.t[s]);
  }
  if (const std::int64_t s = first_bad(field.radiance); s >= 0) {
    return fmt::format("ray {}, stage colour, sample at t = {}", samples.ray[s], samples.t[s]);
  }
  if (const std::int64_t r = first_bad(rgb); r >= 0) {
    return fmt::format("ray {}, stage compositing", r);
  }
  if (const std::int64_t r = first_bad(target); r >= 0) {
    return fmt::format("ray {}, stage target colours", r);
  }
  return "stage loss";
}

}  // namespace nerf
