#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "nerf/model/run_folder.h"

namespace nerf {

// The flag --with of commands that render a run.
inline void AddModelChoice(CLI::App& command, std::string& with) {
  command.add_option("--with", with, "field, or splats: the Gaussians that nerf splat made")
      ->check(CLI::IsMember({"field", "splats"}))
      ->capture_default_str();
}

// Throws InputError for Gaussians that the run does not have.
inline std::shared_ptr<const SceneModel> ChosenModel(const OpenedRun& run, const std::string& with,
                                                     const std::filesystem::path& folder) {
  if (with == "splats") return OpenGaussians(folder);
  return run.model;
}

}  // namespace nerf
