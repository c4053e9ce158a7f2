#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "nerf/render/image_renderer.h"
#include "nerf/render/stage_seconds.h"

namespace nerf {

// What nerf eval measures of a view.
struct Score {
  std::string name;
  double psnr = 0, ssim = 0, seconds = 0;
};

// What the views took, all together.
struct Cost {
  std::int64_t views = 0, pixels = 0, samples = 0;
  StageSeconds seconds;
  double reading = 0;  // seconds, of photographs

  void Add(const RenderedView& view) {
    ++views;
    pixels += static_cast<std::int64_t>(view.rgb.width) * view.rgb.height;
    samples += view.samples;
    seconds.Add(view.seconds);
  }
  double SamplesPerRay() const {
    return static_cast<double>(samples) / static_cast<double>(pixels);
  }
  double PerView(double seconds_of_all) const {
    return seconds_of_all / static_cast<double>(views);
  }
};

// What eval.json tells, beside what the run is.
nlohmann::json JsonFromScores(const std::vector<Score>& scores, const Cost& cost);

// A row for each view and their mean, and what a frame took.
void PrintScores(const std::vector<Score>& scores, const Cost& cost);

}  // namespace nerf
