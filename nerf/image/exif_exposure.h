#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace nerf {

// The exposure that a camera recorded.
struct ExifExposure {
  double stops = 0;           // log2 of (time * ISO / 100 / f-number^2)
  std::string contradiction;  // which entries are invalid or contradict each other; then `stops` is
                              // meaningless. Empty: none
};

// Reads ExposureTime, FNumber (or their APEX forms, ShutterSpeedValue and ApertureValue) and ISO.
//   returns  nullopt where the file has no exposure time
// Source: CIPA DC-008 (Exif 2.32), section 4.6.5.
std::optional<ExifExposure> ReadExifExposure(const std::filesystem::path& path);

}  // namespace nerf
