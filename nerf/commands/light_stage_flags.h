#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>

#include "nerf/synthetic/light_stage.h"

namespace nerf {

// --light-stage and what goes with it, of `nerf sample`.
struct LightStageFlags {
  synthetic::LightStageOptions options;
  const CLI::Option* light_stage = nullptr;

  // Whether a light stage is asked for, if only with a number of lights that is refused later.
  bool Given() const { return light_stage != nullptr && light_stage->count() > 0; }
};
// To be added after the flags of the ordinary sample, most of which it excludes.
void AddLightStageFlags(CLI::App& command, LightStageFlags& flags);

// Writes the capture and says so. Throws InputError, and CLI::RuntimeError after Ctrl-C.
void RunLightStage(const std::filesystem::path& folder, const LightStageFlags& flags, int width,
                   int height, int threads);

}  // namespace nerf
