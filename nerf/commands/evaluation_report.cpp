#include "nerf/commands/evaluation_report.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "nerf/base/peak_memory.h"

namespace nerf {
namespace {

// JSON has no infinity.
nlohmann::json JsonNumber(double value) {
  return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json("inf");
}

}  // namespace

nlohmann::json JsonFromEvaluation(const Evaluation& evaluation) {
  const ViewScore mean = evaluation.Mean();
  const RenderCost& cost = evaluation.cost;
  nlohmann::json images = nlohmann::json::array();
  for (const ViewScore& s : evaluation.scores) {
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
          {"width", cost.width},
          {"height", cost.height},
          {"samples_per_ray", cost.SamplesPerRay()},
          {"peak_megabytes", PeakMegabytes()},
          {"images", images}};
}

void PrintEvaluation(const Evaluation& evaluation) {
  const RenderCost& cost = evaluation.cost;
  std::size_t width = 5;
  for (const ViewScore& s : evaluation.scores) width = std::max(width, s.name.size());
  fmt::print("{:<{}}  {:>8}  {:>7}  {:>9}\n", "image", width, "PSNR dB", "SSIM", "seconds");
  const auto row = [width](const ViewScore& s) {
    fmt::print("{:<{}}  {:>8.2f}  {:>7.4f}  {:>9.2f}\n", s.name, width, s.psnr, s.ssim, s.seconds);
  };
  for (const ViewScore& s : evaluation.scores) row(s);
  row(evaluation.Mean());
  fmt::print("{} x {} pixels, {:.1f} samples per ray, {:.0f} MB peak memory\n", cost.width,
             cost.height, cost.SamplesPerRay(), PeakMegabytes());
  if (cost.seconds.Sum() == 0) return;  // the renderer does not time its stages
  fmt::print(
      "per frame: sampling {:.2f} s, encoding {:.2f} s, networks {:.2f} s, compositing {:.2f} s, "
      "other {:.2f} s\n",
      cost.PerView(cost.seconds.sampling), cost.PerView(cost.seconds.encoding),
      cost.PerView(cost.seconds.networks), cost.PerView(cost.seconds.compositing),
      std::max(0.0, evaluation.Mean().seconds - cost.PerView(cost.seconds.Sum())));
}

nlohmann::json JsonFromMeasurements(const std::vector<EffectMeasurement>& all, int steps) {
  nlohmann::json effects = nlohmann::json::array();
  for (const EffectMeasurement& m : all) {
    effects.push_back({{"effect", m.effect->name},
                       {"psnr_with", m.with.psnr},
                       {"psnr_without", m.without.psnr},
                       {"on_halves", m.on_halves},
                       {"seconds_a_step_with", m.with.seconds_per_step},
                       {"seconds_a_step_without", m.without.seconds_per_step},
                       {"megabytes", m.with.megabytes - m.without.megabytes}});
  }
  return {{"steps", steps}, {"effects", effects}};
}

void PrintMeasurements(const std::vector<EffectMeasurement>& all, int steps) {
  if (all.empty()) {
    fmt::print("the run simulates no effect that can be measured\n");
    return;
  }
  fmt::print("{:<17} {:>8} {:>9} {:>8} {:>16} {:>9}\n", "effect", "with dB", "without", "gain dB",
             "time per step", "memory MB");
  for (const EffectMeasurement& m : all) {
    fmt::print("{:<17} {:>8.2f} {:>9.2f} {:>+8.2f} {:>+14.1f} % {:>+9.2f}\n", m.effect->name,
               m.with.psnr, m.without.psnr, m.with.psnr - m.without.psnr,
               100 * (m.with.seconds_per_step / m.without.seconds_per_step - 1),
               m.with.megabytes - m.without.megabytes);
  }
  fmt::print(
      "after {} steps, on held-out photographs, each at its fitted exposure; gains can change with "
      "longer training\n",
      steps);
  for (const EffectMeasurement& m : all) {
    if (!m.on_halves) continue;
    fmt::print("{}: on the right halves of photographs whose left halves are trained on\n",
               m.effect->name);
  }
}

namespace {

nlohmann::json JsonFromScores(const TruthScores& scores) {
  const auto number = [](const std::optional<double>& value) {
    return value ? nlohmann::json(*value) : nlohmann::json();
  };
  return {{"normal_degrees", number(scores.normal_degrees)},
          {"albedo_psnr", number(scores.albedo_psnr)},
          {"albedo_psnr_unscaled", number(scores.albedo_psnr_unscaled)},
          {"albedo_scale", scores.scale},
          {"roughness_error", number(scores.roughness_error)},
          {"relit_psnr", scores.relit_psnr}};
}

void PrintRow(const std::string& name, const std::optional<double>& found,
              const std::optional<double>& trivial) {
  if (!found) return;
  fmt::print("{:<34} {:>8.2f} {:>8}\n", name, *found,
             trivial ? fmt::format("{:.2f}", *trivial) : "-");
}

}  // namespace

nlohmann::json JsonFromLightEffects(const LightEffectMeasurements& measured) {
  nlohmann::json effects = nlohmann::json::array();
  for (const LightEffectMeasurement& m : measured.effects) {
    effects.push_back({{"effect", m.effect},
                       {"psnr_with", measured.psnr},
                       {"psnr_without", m.psnr_without},
                       {"seconds_a_view_with", m.seconds_with},
                       {"seconds_a_view_without", m.seconds_without}});
  }
  return effects;
}

void PrintLightEffects(const LightEffectMeasurements& measured) {
  fmt::print("\n{:<17} {:>8} {:>9} {:>8} {:>16}\n", "effect of light", "with dB", "without",
             "gain dB", "seconds a view");
  for (const LightEffectMeasurement& m : measured.effects) {
    fmt::print("{:<17} {:>8.2f} {:>9.2f} {:>+8.2f} {:>7.2f}, {:>5.2f} without\n", m.effect,
               measured.psnr, m.psnr_without, measured.psnr - m.psnr_without, m.seconds_with,
               m.seconds_without);
  }
  fmt::print(
      "of held-out photographs under the light that was found for them, with the same materials\n");
}

nlohmann::json JsonFromComparison(const TruthComparison& comparison) {
  return {{"views", comparison.views},
          {"found", JsonFromScores(comparison.found)},
          {"trivial", JsonFromScores(comparison.trivial)},
          {"seconds_per_light", comparison.light_seconds},
          {"seconds_per_view", comparison.view_seconds},
          {"mask", "alpha of the truth"}};
}

void PrintComparison(const TruthComparison& comparison) {
  const TruthScores &found = comparison.found, &trivial = comparison.trivial;
  fmt::print("{:<34} {:>8} {:>8}\n", fmt::format("{} views", comparison.views), "found", "trivial");
  PrintRow("normals, degrees", found.normal_degrees, trivial.normal_degrees);
  PrintRow("albedo, dB", found.albedo_psnr, trivial.albedo_psnr);
  PrintRow("albedo without its scale, dB", found.albedo_psnr_unscaled,
           trivial.albedo_psnr_unscaled);
  PrintRow("roughness, mean difference", found.roughness_error, trivial.roughness_error);
  for (const auto& [light, psnr] : found.relit_psnr) {
    PrintRow(fmt::format("relit by {}, dB", light), psnr, trivial.relit_psnr.at(light));
  }
  fmt::print(
      "the albedo is scaled by {:.3f} {:.3f} {:.3f}, the medians of truth over what was found; the "
      "mask is the alpha of the truth\n"
      "trivial: normals of the field's density, its picture as the albedo and as the relit view\n"
      "{:.1f} s for bounces under a light, {:.2f} s a view\n",
      found.scale[0], found.scale[1], found.scale[2], comparison.light_seconds,
      comparison.view_seconds);
}

}  // namespace nerf
