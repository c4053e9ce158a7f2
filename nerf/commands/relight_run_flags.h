#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "nerf/commands/shots.h"

namespace nerf {

// Options of nerf relight that are of trained runs only.
struct RelightRunFlags {
  ShotOptions shots;
  std::optional<int> bounces;
  std::string edit;
  std::string background = "stay";

  bool UsesAny() const {
    return !shots.image.empty() || !shots.pose.empty() || !shots.path.empty() || shots.downscale ||
           bounces || !edit.empty() || background != "stay";
  }
};

inline void AddRelightRunFlags(CLI::App& command, RelightRunFlags& flags) {
  auto* image = command.add_option("--image", flags.shots.image,
                                   "of a run: the view of this photograph [held-out ones]");
  auto* pose =
      command.add_option("--pose", flags.shots.pose, "of a run: the view of this JSON file")
          ->excludes(image);
  command
      .add_option("--path", flags.shots.path, "of a run: orbit, spiral, training, or a JSON file")
      ->excludes(image)
      ->excludes(pose);
  command
      .add_option("--downscale", flags.shots.downscale,
                  "of a run: reduce the resolution by this factor")
      ->check(CLI::Range(1, 1024));
  command
      .add_option("--bounces", flags.bounces,
                  "of a run: how often light is reflected before it is seen [2]")
      ->check(CLI::Range(0, 64));
  command.add_option("--edit", flags.edit,
                     "of a run: a JSON file that changes materials (docs/relighting.md)");
  command
      .add_option("--background", flags.background,
                  "of a run: stay: as photographed; map: the environment")
      ->check(CLI::IsMember({"stay", "map"}))
      ->capture_default_str();
}

}  // namespace nerf
