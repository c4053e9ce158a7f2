#include "nerf/train/training_display.h"

#include <spdlog/fmt/fmt.h>

namespace nerf {

std::string PriceOfQuality(const QualityCurve& curve) {
  constexpr double kGain = 0.5;  // dB
  std::string text;
  if (const auto psnr = curve.Last()) text += fmt::format("{:.2f} dB", *psnr);
  if (const auto last = curve.SecondsOfLast(kGain)) {
    text += fmt::format(", last +{} dB cost {}", kGain, FormatSeconds(*last));
  }
  if (const auto next = curve.SecondsForNext(kGain)) {
    text += fmt::format(", next about {}", FormatSeconds(*next));
  }
  return text;
}

void TrainingDisplay::Update(std::int64_t done, double loss, double rays_per_second,
                             const QualityCurve& curve) {
  constexpr double kSmoothing = 0.95;
  const double keep = rays_per_second_ == 0 ? 0.0 : kSmoothing;
  loss_ = keep * loss_ + (1 - keep) * loss;
  rays_per_second_ = keep * rays_per_second_ + (1 - keep) * rays_per_second;
  if (!ProgressLine::IsTerminal()) return;
  progress_.Update(done, fmt::format("loss {:.5f}  {:.1f}k rays/s  {}", loss_,
                                     rays_per_second_ / 1e3, PriceOfQuality(curve)));
}

}  // namespace nerf
