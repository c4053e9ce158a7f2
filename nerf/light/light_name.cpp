#include "nerf/light/light_name.h"

#include <charconv>

#include "nerf/base/input_error.h"
#include "nerf/light/spectrum.h"

namespace nerf {
namespace {

constexpr std::string_view kBlackBody = "blackbody:";
// The names of daylights are from before c2 was revised.
constexpr double kDaylightScale = 1.4388 / 1.4380;

std::optional<double> NumberFrom(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

void CheckTemperature(std::string_view name, double kelvin, double lowest, double highest) {
  if (kelvin >= lowest && kelvin <= highest) return;
  throw InputError("light {}: {} K; choose {} to {} K", name, kelvin, lowest, highest);
}

Color OfUnitLuminance(const Spectrum& spectrum) {
  const Eigen::Vector3d xyz = XyzFromSpectrum(spectrum);
  const Color in_gamut = LinearSrgbFromXyz(xyz / xyz.y()).max(0);
  return in_gamut / Luminance(in_gamut);
}

}  // namespace

std::optional<Spectrum> SpectrumOfLight(std::string_view name) {
  if (name == "A") return IlluminantA();
  if (name == "E") return EqualEnergy();
  if (name.starts_with(kBlackBody)) {
    const auto kelvin = NumberFrom(name.substr(kBlackBody.size()));
    if (!kelvin) return std::nullopt;
    CheckTemperature(name, *kelvin, 1000, 100'000);
    return BlackBody(*kelvin);
  }
  if (name.starts_with('D')) {
    const auto hundreds = NumberFrom(name.substr(1));
    if (!hundreds) return std::nullopt;
    CheckTemperature(name, *hundreds * 100, 4000, 25'000);
    return Daylight(*hundreds * 100 * kDaylightScale);
  }
  return std::nullopt;
}

std::optional<Color> ColorOfLight(std::string_view name) {
  const std::optional<Spectrum> spectrum = SpectrumOfLight(name);
  if (!spectrum) return std::nullopt;
  return OfUnitLuminance(*spectrum);
}

}  // namespace nerf
