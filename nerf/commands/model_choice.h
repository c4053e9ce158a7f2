#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "nerf/model/representation_record.h"
#include "nerf/model/run_folder.h"

namespace nerf {

// The flag --with of commands that render a run.
inline void AddModelChoice(CLI::App& command, std::string& with) {
  command
      .add_option("--with", with,
                  "field; splats: the Gaussians that training or nerf splat made; auto: the better "
                  "one on validation photographs")
      ->check(CLI::IsMember({"auto", "field", "splats"}))
      ->capture_default_str();
}

// Resolves auto. Throws InputError for Gaussians that the run does not have.
inline bool UsesSplats(const std::string& with, const std::filesystem::path& run) {
  if (with == "field") return false;
  if (with == "splats") return true;
  return std::filesystem::exists(GaussiansPath(run)) &&
         ReadRepresentation(run).Best() == Representation::kSplats;
}

inline std::shared_ptr<const SceneModel> ChosenModel(const OpenedRun& run, bool uses_splats,
                                                     const std::filesystem::path& folder) {
  if (uses_splats) return OpenGaussians(folder);
  return run.model;
}

}  // namespace nerf
