#include "nerf/scene/pixel_sampler.h"

#include <algorithm>
#include <atomic>

#include "nerf/base/input_error.h"
#include "nerf/base/parallel.h"
#include "nerf/base/random.h"
#include "nerf/scene/camera.h"

namespace nerf {
namespace {

constexpr std::uint64_t kPixelStream = 0x706978656c5f5f5full;
constexpr std::uint64_t kBackgroundStream = 0x6261636b67726e64ull;
constexpr std::uint64_t kJitterStream = 0x6a69747465725f5full;

// Random streams of different steps must not overlap.
std::uint64_t StreamOfStep(std::uint64_t stream, std::uint64_t step) {
  return Mix64(stream + step);
}

// Writes ray r of the batch. False where the lens distortion cannot be inverted at the pixel.
bool SetRay(RayBatch& rays, std::int64_t r, const Camera& camera,
            const Eigen::Isometry3d& normalized_from_camera, const Eigen::Vector2d& pixel) {
  const auto direction = DirectionFromPixel(camera, pixel);
  if (!direction) return false;
  const Eigen::Vector3d d = normalized_from_camera.linear() * *direction;
  const Eigen::Vector3d& o = normalized_from_camera.translation();
  Eigen::Map<Eigen::Vector3f>(&rays.direction[3 * r]) = d.cast<float>();
  Eigen::Map<Eigen::Vector3f>(&rays.origin[3 * r]) = o.cast<float>();
  rays.spread[r] = static_cast<float>(std::max(0.0, direction->z()) / FocalLength(camera));
  return true;
}

// In [0, 1).
double UnitFrom(std::uint64_t bits) { return static_cast<double>(Mix64(bits) >> 11) * 0x1p-53; }

// Draws one item uniformly from consecutive runs: the run, and the index within it.
//   first  [runs+1] running count
std::pair<std::size_t, std::int64_t> DrawFromRuns(std::span<const std::int64_t> first,
                                                  std::uint64_t bits) {
  const auto chosen = static_cast<std::int64_t>(bits % static_cast<std::uint64_t>(first.back()));
  const auto after = std::ranges::upper_bound(first, chosen);
  return {static_cast<std::size_t>(after - first.begin() - 1), chosen - *(after - 1)};
}

}  // namespace

PixelSampler::PixelSampler(const std::vector<View>& views, double error_driven_share,
                           double depth_share)
    : views_(views),
      error_driven_share_(error_driven_share),
      depth_share_(depth_share),
      first_pixel_{0},
      first_observation_{0} {
  for (const View& view : views) {
    first_pixel_.push_back(first_pixel_.back() + view.StoredCount());
    first_observation_.push_back(first_observation_.back() + std::ssize(view.depth_observations));
  }
  if (first_observation_.back() == 0) depth_share_ = 0;
  if (error_driven_share > 0) errors_.emplace(views);
}

// Draws an observation uniformly; nullopt where its pixel is not stored.
std::optional<PixelSampler::Drawn> PixelSampler::DrawDepthObservation(std::uint64_t bits) const {
  const auto [v, k] = DrawFromRuns(first_observation_, bits);
  const DepthObservation& observation = views_[v].depth_observations[k];
  const std::int64_t stored = views_[v].StoredNear(observation.pixel);
  if (views_[v].PixelIndex(stored) != observation.pixel) return std::nullopt;
  return Drawn{v, stored, observation.distance};
}

PixelSampler::Drawn PixelSampler::Draw(std::uint64_t bits) const {
  constexpr std::uint64_t kChoice = 0x63686f6963655f5full, kPlace = 0x706c6163655f5f5full;
  constexpr std::uint64_t kPointChoice = 0x706f696e745f5f5full, kPoint = 0x706f696e74616765ull;
  if (UnitFrom(bits ^ kPointChoice) < depth_share_) {
    if (const auto drawn = DrawDepthObservation(Mix64(bits ^ kPoint))) return *drawn;
  }
  if (errors_ && UnitFrom(bits ^ kChoice) < error_driven_share_) {
    const ErrorMap::Pixel pixel = errors_->Draw(Mix64(bits ^ kPlace));
    return {pixel.view, views_[pixel.view].StoredNear(pixel.index)};
  }
  const auto [v, stored] = DrawFromRuns(first_pixel_, bits);
  return {v, stored};
}

TargetBatch PixelSampler::Sample(std::int64_t rays, std::uint64_t seed, std::uint64_t step) const {
  TargetBatch batch;
  batch.rays.Resize(rays);
  batch.rays.spread.resize(rays);
  batch.rgb.resize(3 * rays);
  batch.photograph.resize(rays);
  batch.pixel.resize(rays);
  if (errors_) batch.cell.resize(rays);
  if (depth_share_ > 0) batch.distance.resize(rays);
  // A pixel without a ray is drawn again, so often that only a lens without valid pixels fails.
  constexpr std::uint64_t kMostDraws = 256;
  std::atomic<bool> failed = false;
  ParallelFor(rays, 64, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t r = begin; r < end; ++r) {
      for (std::uint64_t draw = 0;; ++draw) {
        if (draw == kMostDraws) {
          failed = true;
          return;
        }
        const std::uint64_t bits =
            RandomBits(seed, StreamOfStep(kPixelStream, step), kMostDraws * r + draw);
        const auto [v, stored, distance] = Draw(bits);
        const View& view = views_[v];
        const std::int64_t pixel = view.PixelIndex(stored);
        const Eigen::Vector2d centre(static_cast<double>(pixel % view.camera.width) + 0.5,
                                     static_cast<double>(pixel / view.camera.width) + 0.5);
        if (!SetRay(batch.rays, r, view.camera, view.normalized_from_camera, centre)) continue;
        batch.photograph[r] = static_cast<std::int64_t>(v);
        batch.pixel[r] = pixel;
        if (depth_share_ > 0) batch.distance[r] = distance;
        if (errors_) batch.cell[r] = errors_->CellOf({v, pixel});
        const Eigen::half* rgba = &view.rgba[4 * stored];
        const auto alpha = static_cast<float>(rgba[3]);
        for (int c = 0; c < 3; ++c) {
          const float background =
              RandomFloat(seed, StreamOfStep(kBackgroundStream, step), 3 * r + c);
          batch.rays.background[3 * r + c] = background;
          batch.rgb[3 * r + c] = alpha * static_cast<float>(rgba[c]) + (1 - alpha) * background;
        }
        batch.rays.jitter[r] = RandomFloat(seed, StreamOfStep(kJitterStream, step), r);
        break;
      }
    }
  });
  if (failed) {
    throw InputError(
        "the lens distortion of the cameras cannot be inverted at almost any pixel; check k1, k2, "
        "p1, p2 in the poses");
  }
  return batch;
}

ViewRays RaysOfPixels(const Camera& camera, const Eigen::Isometry3d& normalized_from_camera,
                      std::span<const std::int64_t> pixels, const Eigen::Vector3f& background) {
  ViewRays out;
  const auto count = static_cast<std::int64_t>(pixels.size());
  out.rays.Resize(count);
  out.rays.spread.resize(count);
  out.valid.assign(count, 1);
  ParallelFor(count, 256, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t r = begin; r < end; ++r) {
      const std::int64_t pixel = pixels[r];
      const Eigen::Vector2d centre(static_cast<double>(pixel % camera.width) + 0.5,
                                   static_cast<double>(pixel / camera.width) + 0.5);
      out.valid[r] = SetRay(out.rays, r, camera, normalized_from_camera, centre);
      Eigen::Map<Eigen::Vector3f>(&out.rays.background[3 * r]) = background;
      out.rays.jitter[r] = 0.5f;
    }
  });
  return out;
}

}  // namespace nerf
