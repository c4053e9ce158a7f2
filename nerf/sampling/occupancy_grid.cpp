#include "nerf/sampling/occupancy_grid.h"

#include <algorithm>
#include <cmath>

#include "nerf/base/parallel.h"
#include "nerf/base/random.h"
#include "nerf/sampling/contraction.h"

namespace nerf {
namespace {

// Random streams, distinct from those of rays and pixels.
constexpr std::uint64_t kPickStream = 0x6f63635f7069636bull;
constexpr std::uint64_t kOffsetStream = 0x6f63635f6f666673ull;

constexpr float kNeverVisible = -1.0f;

constexpr int kBlock = 4;
constexpr std::uint8_t kFarthestBlock = 255;

}  // namespace

OccupancyGrid::OccupancyGrid(const OccupancyOptions& options, float step_length)
    : options_(options), step_length_(step_length) {
  const std::int64_t n = options.resolution;
  density_.assign(n * n * n, 0.0f);
  occupied_.assign(n * n * n, 1);
  blocks_ = (options.resolution + kBlock - 1) / kBlock;
  UpdateBlockDistances();
}

float OccupancyGrid::FreeRadius(const Eigen::Vector3f& position) const {
  const Eigen::Array3i block =
      (position.array() * (static_cast<float>(options_.resolution) / kBlock))
          .cast<int>()
          .min(blocks_ - 1)
          .max(0);
  const int distance = block_distance_[(block[2] * blocks_ + block[1]) * blocks_ + block[0]];
  // The least distance from any position in the block to a block that many blocks away.
  return static_cast<float>(std::max(0, distance - 1) * kBlock) * 4.0f /
         static_cast<float>(options_.resolution);
}

// The chessboard distance transform of blocks in two passes. Source: Rosenfeld and Pfaltz 1968.
void OccupancyGrid::UpdateBlockDistances() {
  const int n = options_.resolution, b = blocks_;
  block_distance_.assign(static_cast<std::size_t>(b) * b * b, kFarthestBlock);
  const auto at = [&](int x, int y, int z) -> std::uint8_t& {
    return block_distance_[(static_cast<std::size_t>(z) * b + y) * b + x];
  };
  for (int z = 0; z < n; ++z) {
    for (int y = 0; y < n; ++y) {
      const std::uint8_t* row = &occupied_[(static_cast<std::size_t>(z) * n + y) * n];
      for (int x = 0; x < n; ++x) {
        if (row[x]) at(x / kBlock, y / kBlock, z / kBlock) = 0;
      }
    }
  }
  // The 13 neighbours that precede a block in scan order (sign 1) or follow it (sign -1).
  const auto relax = [&](int x, int y, int z, int sign) {
    int least = at(x, y, z);
    for (int k = 0; k < 13; ++k) {
      const int nx = x + sign * (k % 3 - 1), ny = y + sign * (k / 3 % 3 - 1),
                nz = z + sign * (k / 9 - 1);
      if (nx < 0 || ny < 0 || nz < 0 || nx >= b || ny >= b || nz >= b) continue;
      least = std::min(least, at(nx, ny, nz) + 1);
    }
    at(x, y, z) = static_cast<std::uint8_t>(least);
  };
  for (int i = 0; i < b * b * b; ++i) relax(i % b, i / b % b, i / (b * b), 1);
  for (int i = b * b * b - 1; i >= 0; --i) relax(i % b, i / b % b, i / (b * b), -1);
}

std::int64_t OccupancyGrid::CellOf(const Eigen::Vector3f& position) const {
  const auto n = static_cast<float>(options_.resolution);
  const Eigen::Array3f scaled = position.array() * n;
  if (!((scaled >= 0).all() && (scaled <= n).all())) return -1;
  const Eigen::Array3i cell = scaled.cast<int>().min(options_.resolution - 1);
  return (static_cast<std::int64_t>(cell[2]) * options_.resolution + cell[1]) *
             options_.resolution +
         cell[0];
}

Eigen::Vector3f OccupancyGrid::CellCorner(std::int64_t cell) const {
  const std::int64_t n = options_.resolution;
  return Eigen::Vector3f(static_cast<float>(cell % n), static_cast<float>(cell / n % n),
                         static_cast<float>(cell / (n * n))) /
         static_cast<float>(n);
}

void OccupancyGrid::KeepVisible(const std::function<bool(const Eigen::Vector3f&, float)>& visible) {
  const float side = 1.0f / static_cast<float>(options_.resolution);
  const float half_diagonal = 0.5f * std::sqrt(3.0f) * side;
  ParallelFor(static_cast<std::int64_t>(density_.size()), 4096,
              [&](std::int64_t begin, std::int64_t end) {
                for (std::int64_t cell = begin; cell < end; ++cell) {
                  const Eigen::Vector3f centre = CellCorner(cell).array() + 0.5f * side;
                  // The corners of the cube are outside the ball of contracted space.
                  const bool in_ball = ContractedFromUnitCube(centre).norm() < 2.0f;
                  density_[cell] = in_ball && visible(centre, half_diagonal) ? 0.0f : kNeverVisible;
                  occupied_[cell] = density_[cell] == 0.0f;
                }
              });
  UpdateBlockDistances();
}

void OccupancyGrid::Update(std::int64_t step, std::uint64_t seed, const DensityFunction& density) {
  const auto cells = static_cast<std::int64_t>(density_.size());
  std::vector<std::int64_t> picked;
  for (std::int64_t cell = 0; cell < cells; ++cell) {
    if (density_[cell] == kNeverVisible) continue;
    const std::uint64_t draw = RandomBits(seed, kPickStream + step, cell) & 7;
    const bool often = occupied_[cell] || step < options_.warmup_steps;
    if (draw < (often ? 2 : 1)) picked.push_back(cell);
  }

  const float side = 1.0f / static_cast<float>(options_.resolution);
  std::vector<float> positions(3 * picked.size());
  for (std::size_t k = 0; k < picked.size(); ++k) {
    const Eigen::Vector3f corner = CellCorner(picked[k]);
    for (int axis = 0; axis < 3; ++axis) {
      const float offset = RandomFloat(seed, kOffsetStream + step, 3 * picked[k] + axis);
      positions[3 * k + axis] = corner[axis] + side * offset;
    }
  }
  const std::vector<float> fresh = density(positions);
  const auto decay = static_cast<float>(options_.decay);

  for (std::size_t k = 0; k < picked.size(); ++k) {
    float& stored = density_[picked[k]];
    stored = std::max(decay * stored, fresh[k]);
  }
  Refresh();
}

void OccupancyGrid::Refresh() {
  // A cell is occupied where a step through it has an opacity of `threshold`. While the whole scene
  // is thinner than that, cells above the mean density are, so that training always has samples.
  double sum = 0;
  std::int64_t seen = 0;
  for (const float stored : density_) {
    if (stored == kNeverVisible) continue;
    sum += std::min(stored, 1e6f);
    ++seen;
  }
  const auto mean = static_cast<float>(seen > 0 ? sum / static_cast<double>(seen) : 0.0);
  const auto opaque = static_cast<float>(-std::log1p(-options_.threshold) / step_length_);
  const float bound = std::min(mean, opaque);
  for (std::size_t cell = 0; cell < density_.size(); ++cell) {
    occupied_[cell] = density_[cell] != kNeverVisible && density_[cell] >= bound;
  }
  UpdateBlockDistances();
}

double OccupancyGrid::OccupiedFraction() const {
  const auto count = std::count(occupied_.begin(), occupied_.end(), std::uint8_t{1});
  return static_cast<double>(count) / static_cast<double>(occupied_.size());
}

}  // namespace nerf
