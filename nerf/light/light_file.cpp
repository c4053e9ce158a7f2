#include "nerf/light/light_file.h"

#include <cmath>
#include <optional>
#include <sstream>
#include <string>

#include "nerf/base/atomic_file.h"
#include "nerf/base/input_error.h"

namespace nerf {
namespace {

// The numbers of a line, without its comment; nullopt if a word is not a finite number.
std::optional<std::vector<double>> NumbersIn(const std::string& line) {
  std::istringstream words(line.substr(0, line.find('#')));
  std::vector<double> numbers;
  for (std::string word; words >> word;) {
    char* end = nullptr;
    const double value = std::strtod(word.c_str(), &end);
    if (*end != '\0' || !std::isfinite(value)) return std::nullopt;
    numbers.push_back(value);
  }
  return numbers;
}

DirectionalLight LightFrom(const std::vector<double>& numbers, const std::string& where) {
  const Eigen::Vector3d direction(numbers[0], numbers[1], numbers[2]);
  if (!(direction.norm() > 0)) {
    throw InputError("{}: the direction of a light must not be 0 0 0", where);
  }
  DirectionalLight light{direction.stableNormalized()};
  if (numbers.size() == 4) light.irradiance *= numbers[3];
  if (numbers.size() == 6) light.irradiance *= Color(numbers[3], numbers[4], numbers[5]);
  if (!(light.irradiance > 0).all()) {
    throw InputError("{}: the intensity of a light must be above 0", where);
  }
  return light;
}

}  // namespace

std::vector<DirectionalLight> ReadLights(const std::filesystem::path& file) {
  std::istringstream text(ReadWholeFile(file));
  std::vector<DirectionalLight> lights;
  std::optional<double> announced;
  int line_number = 0;
  for (std::string line; std::getline(text, line);) {
    const std::string where = fmt::format("{}:{}", file.string(), ++line_number);
    const auto numbers = NumbersIn(line);
    if (numbers && numbers->empty()) continue;
    if (numbers && numbers->size() == 1 && lights.empty() && !announced) {
      announced = numbers->front();
      continue;
    }
    if (!numbers || (numbers->size() != 3 && numbers->size() != 4 && numbers->size() != 6)) {
      throw InputError("{}: expected a light, \"x y z\", \"x y z i\" or \"x y z r g b\"", where);
    }
    lights.push_back(LightFrom(*numbers, where));
  }
  if (announced && *announced != static_cast<double>(lights.size())) {
    throw InputError("{}: the first line announces {} lights, {} follow; correct one of them",
                     file.string(), *announced, lights.size());
  }
  if (lights.empty()) throw InputError("{}: contains no lights", file.string());
  return lights;
}

void WriteLights(const std::filesystem::path& file, std::span<const DirectionalLight> lights) {
  std::string text = "# towards each light: x right, y up, z to the camera; intensity r g b\n";
  for (const DirectionalLight& light : lights) {
    const Eigen::Vector3d& d = light.to_light;
    text += fmt::format("{:.9f} {:.9f} {:.9f}", d.x(), d.y(), d.z());
    const Color intensity = light.irradiance / std::numbers::pi;
    if (!(intensity == 1).all()) {
      text += fmt::format(" {:.9g} {:.9g} {:.9g}", intensity.x(), intensity.y(), intensity.z());
    }
    text += '\n';
  }
  WriteFileAtomically(file, text);
}

}  // namespace nerf
