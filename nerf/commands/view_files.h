#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>

#include "nerf/model/scene_facts.h"
#include "nerf/render/image_renderer.h"

namespace nerf {

// What is written of a view.
struct ViewFiles {
  std::string format = "png";
  bool depth = false;
  bool opacity = false;
  bool surface = false;  // median depth and normals
};

void AddViewFiles(CLI::App& command, ViewFiles& files);

// Writes STEM.png or what the format is, and the files that are asked for, in the frame and units
// of the input.
void WriteView(const RenderedView& view, const SceneFacts& scene, const ViewFiles& files,
               const std::filesystem::path& stem);

}  // namespace nerf
