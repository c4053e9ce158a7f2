#include "nerf/image/exif_exposure.h"

#include <spdlog/fmt/fmt.h>

#include <cmath>
#include <limits>

#include "nerf/image/oiio_files.h"

namespace nerf {
namespace {

// Difference in stops that counts as a contradiction. Cameras round the APEX forms.
constexpr double kContradiction = 1.0;

constexpr float kAbsent = std::numeric_limits<float>::quiet_NaN();

// A quantity that may be in the file as a plain number and as a logarithm (APEX), in stops.
struct Quantity {
  std::optional<double> stops;
  std::string contradiction;
};

Quantity FromBoth(const char* plain_name, float plain, double stops_of_plain, const char* apex_name,
                  float apex, double stops_of_apex) {
  if (!std::isnan(plain) && !(plain > 0 && std::isfinite(plain))) {
    return {0.0, fmt::format("{} is {}", plain_name, plain)};
  }
  if (std::isnan(plain) && std::isnan(apex)) return {};
  if (std::isnan(plain)) return {stops_of_apex, ""};
  if (!std::isnan(apex) && std::fabs(stops_of_plain - stops_of_apex) > kContradiction) {
    return {stops_of_plain, fmt::format("{} {} and {} {} contradict each other", plain_name, plain,
                                        apex_name, apex)};
  }
  return {stops_of_plain, ""};
}

}  // namespace

std::optional<ExifExposure> ReadExifExposure(const std::filesystem::path& path) {
  const auto input = OpenImageInput(path);
  if (!input) {
    OIIO::geterror();  // training reports the file
    return std::nullopt;
  }
  const OIIO::ImageSpec& spec = input->spec();
  const auto number = [&spec](const char* name) { return spec.get_float_attribute(name, kAbsent); };
  const float time = number("ExposureTime"), shutter = number("Exif:ShutterSpeedValue");
  const float f_number = number("FNumber"), aperture = number("Exif:ApertureValue");
  float iso = number("Exif:PhotographicSensitivity");
  if (std::isnan(iso)) iso = number("Exif:ISOSpeedRatings");
  const Quantity of_time = FromBoth("ExposureTime", time, std::log2(static_cast<double>(time)),
                                    "ShutterSpeedValue", shutter, -static_cast<double>(shutter));
  const Quantity of_lens =
      FromBoth("FNumber", f_number, -2 * std::log2(static_cast<double>(f_number)), "ApertureValue",
               aperture, -static_cast<double>(aperture));
  if (!of_time.stops) return std::nullopt;
  ExifExposure exposure;
  exposure.contradiction = of_time.contradiction + of_lens.contradiction;
  if (!std::isnan(iso) && !(iso > 0)) exposure.contradiction = fmt::format("ISO is {}", iso);
  exposure.stops = *of_time.stops + of_lens.stops.value_or(0.0) +
                   (std::isnan(iso) ? 0.0 : std::log2(static_cast<double>(iso) / 100));
  return exposure;
}

}  // namespace nerf
