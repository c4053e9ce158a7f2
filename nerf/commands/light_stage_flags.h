#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>

#include "nerf/appearance/light_stage.h"

namespace nerf {

// --light-stage and what goes with it, of `nerf sample`.
struct LightStageFlags {
  appearance::LightStageOptions options{.lights = 0};

  bool Given() const { return options.lights != 0; }
};
void AddLightStageFlags(CLI::App& command, LightStageFlags& flags);

// Writes the capture and says so. Throws sfm::InputError, and CLI::RuntimeError after Ctrl-C.
void RunLightStage(const std::filesystem::path& folder, const LightStageFlags& flags, int width,
                   int height, int threads);

}  // namespace nerf
