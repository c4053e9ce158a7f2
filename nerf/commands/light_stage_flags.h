#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>

#include "nerf/synthetic/light_stage.h"

namespace nerf {

// The flag --light-stage of `nerf sample`, and those that need it.
struct LightStageFlags {
  synthetic::LightStageOptions options;
  const CLI::Option* light_stage = nullptr;

  // Whether --light-stage was given, with a valid number of lights or not.
  bool Given() const { return light_stage != nullptr && light_stage->count() > 0; }
};
// Call after the flags of an ordinary sample have been added, for most of them are excluded.
void AddLightStageFlags(CLI::App& command, LightStageFlags& flags);

// Writes the capture and prints what was written. Throws InputError, and CLI::RuntimeError after
// Ctrl-C.
void RunLightStage(const std::filesystem::path& folder, const LightStageFlags& flags, int width,
                   int height, int threads);

}  // namespace nerf
