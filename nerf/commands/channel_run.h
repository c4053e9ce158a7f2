#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "nerf/commands/shots.h"

namespace nerf {

// nerf render --channel: what a run with materials consists of.
struct ChannelOptions {
  std::vector<std::string> channels;  // of ChannelNames(); empty: pictures, as always
  std::string edit;                   // an edits.json
};

void AddChannelOptions(CLI::App& command, ChannelOptions& options);

// Writes VIEW_CHANNEL.png and VIEW_CHANNEL.exr, linear, under the light of the photographs, the
// first where there are several. Throws InputError where the run has no materials.
void RenderChannels(const OpenedRun& run, const std::filesystem::path& folder_of_run,
                    const ChannelOptions& options, const ShotList& list,
                    const std::filesystem::path& output);

}  // namespace nerf
