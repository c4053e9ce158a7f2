#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>

#include "nerf/synthetic/light_stage.h"

namespace nerf {

// The flag --light-stage of `nerf sample`, and the flags that require it.
struct LightStageFlags {
  synthetic::LightStageOptions options;
  const CLI::Option* light_stage = nullptr;

  // Whether --light-stage was given, even with an invalid number of lights.
  bool Given() const { return light_stage != nullptr && light_stage->count() > 0; }
};
// Must be called after the flags of an ordinary sample are added, because it excludes most of them.
void AddLightStageFlags(CLI::App& command, LightStageFlags& flags);

// Writes the capture and reports it. Throws InputError, and CLI::RuntimeError after Ctrl-C.
void RunLightStage(const std::filesystem::path& folder, const LightStageFlags& flags, int width,
                   int height, int threads);

}  // namespace nerf
