#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "nerf/capture/olat_capture.h"

namespace nerf {

// --lights auto|chrome|FILE: where the directions of the lights of a capture come from.
inline void AddLightsOption(CLI::App& command, OlatOptions& options) {
  command
      .add_option_function<std::string>(
          "--lights",
          [&options](const std::string& value) {
            options.lights = value == "auto"     ? LightCalibration::kAuto
                             : value == "chrome" ? LightCalibration::kChromeBall
                                                 : LightCalibration::kFile;
            options.light_file = value;
          },
          "directions of the lights: a file; chrome: from the highlights on a chrome ball; auto: "
          "lights.txt, light_directions.txt or an .lp file if there is one, else the ball; of a "
          "run: "
          "a lights.json")
      ->default_str("auto");
}

}  // namespace nerf
