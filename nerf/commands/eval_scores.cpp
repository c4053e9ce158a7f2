#include "nerf/commands/eval_scores.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

#include "nerf/base/peak_memory.h"

namespace nerf {
namespace {

// JSON has no infinity; equal images are said in words.
nlohmann::json JsonNumber(double value) {
  return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json("inf");
}

Score MeanOf(const std::vector<Score>& scores) {
  Score mean{"mean", 0, 0, 0};
  for (const Score& s : scores) {
    mean.psnr += s.psnr;
    mean.ssim += s.ssim;
    mean.seconds += s.seconds;
  }
  const auto count = static_cast<double>(scores.size());
  return {mean.name, mean.psnr / count, mean.ssim / count, mean.seconds / count};
}

}  // namespace

nlohmann::json JsonFromScores(const std::vector<Score>& scores, const Cost& cost) {
  const Score mean = MeanOf(scores);
  nlohmann::json images = nlohmann::json::array();
  for (const Score& s : scores) {
    images.push_back(
        {{"name", s.name}, {"psnr", JsonNumber(s.psnr)}, {"ssim", s.ssim}, {"seconds", s.seconds}});
  }
  return {{"psnr", JsonNumber(mean.psnr)},
          {"ssim", mean.ssim},
          {"seconds_per_frame", mean.seconds},
          {"stage_seconds_per_frame",
           {{"sampling", cost.PerView(cost.seconds.sampling)},
            {"encoding", cost.PerView(cost.seconds.encoding)},
            {"networks", cost.PerView(cost.seconds.networks)},
            {"compositing", cost.PerView(cost.seconds.compositing)},
            {"reading_photographs", cost.PerView(cost.reading)}}},
          {"samples_per_ray", cost.SamplesPerRay()},
          {"peak_megabytes", PeakMegabytes()},
          {"images", images}};
}

void PrintScores(const std::vector<Score>& scores, const Cost& cost) {
  std::size_t width = 5;
  for (const Score& s : scores) width = std::max(width, s.name.size());
  fmt::print("{:<{}}  {:>8}  {:>7}  {:>9}\n", "image", width, "PSNR dB", "SSIM", "seconds");
  const auto row = [width](const Score& s) {
    fmt::print("{:<{}}  {:>8.2f}  {:>7.4f}  {:>9.2f}\n", s.name, width, s.psnr, s.ssim, s.seconds);
  };
  for (const Score& s : scores) row(s);
  row(MeanOf(scores));
  fmt::print("{:.1f} samples a ray, {:.0f} MB at most\n", cost.SamplesPerRay(), PeakMegabytes());
  if (cost.seconds.Sum() == 0) return;  // of a renderer that does not tell
  fmt::print("of a frame: sampling {:.2f} s, encoding {:.2f} s, networks {:.2f} s, rest {:.2f} s\n",
             cost.PerView(cost.seconds.sampling), cost.PerView(cost.seconds.encoding),
             cost.PerView(cost.seconds.networks), cost.PerView(cost.seconds.compositing));
}

}  // namespace nerf
