#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace nerf {

// What a camera has written of its exposure.
struct ExifExposure {
  double stops = 0;           // log2 of the light that the sensor took in: time * ISO / f-number^2
  std::string contradiction;  // empty, or what about it cannot be: then the stops mean nothing
};

// Reads ExposureTime, FNumber (or their APEX forms, ShutterSpeedValue and ApertureValue) and ISO.
//   returns  nullopt where the file has none of them, or not enough
// Source: CIPA DC-008 (Exif 2.32), section 4.6.5.
std::optional<ExifExposure> ReadExifExposure(const std::filesystem::path& path);

}  // namespace nerf
