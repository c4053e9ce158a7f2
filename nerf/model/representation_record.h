#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "nerf/config/train_options.h"

namespace nerf {

// Validation PSNR of both representations, dB.
struct ComparedPsnr {
  double field = 0, splats = 0;
};

// What is known of the representations of a run: RUN/representation.json. A run without that file
// has a field only.
struct RepresentationRecord {
  // The decision whether training makes Gaussians, and the trial that led to it; nullopt: none yet.
  std::optional<bool> makes_splats;
  std::optional<ComparedPsnr> tried;
  double field_seconds = 0;  // the end of the field's part of the time budget; 0: there is none
  std::int64_t field_steps = -1;  // of the field, once it has ended before Gaussians; -1: not yet
  std::optional<ComparedPsnr> reached;  // at the end
  // Gaussians were asked for by name and have ended, but nothing validates.
  bool splats_stand = false;

  // What was reached is of a field or Gaussians that are no more.
  void ForgetReached();

  // Which one `nerf render` and `nerf eval` use.
  Representation Best() const;
};

// Throws InputError naming a damaged file.
RepresentationRecord ReadRepresentation(const std::filesystem::path& run);
void WriteRepresentation(const RepresentationRecord& record, const std::filesystem::path& run);

}  // namespace nerf
