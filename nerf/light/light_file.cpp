#include "nerf/light/light_file.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>
#include <sstream>
#include <string>

#include "nerf/base/atomic_file.h"
#include "nerf/base/input_error.h"
#include "nerf/base/text.h"
#include "nerf/image/image_files.h"

namespace nerf {
namespace {

// A line without its comment: the name of an image, if there is one, and numbers.
struct Line {
  std::string image;
  std::vector<double> numbers;
};

// nullopt if a word is not a finite number.
std::optional<std::vector<double>> NumbersIn(const std::string& text) {
  std::istringstream words(text);
  std::vector<double> numbers;
  for (std::string word; words >> word;) {
    char* end = nullptr;
    const double value = std::strtod(word.c_str(), &end);
    if (*end != '\0' || !std::isfinite(value)) return std::nullopt;
    numbers.push_back(value);
  }
  return numbers;
}

bool IsNumber(const std::string& word) {
  char* end = nullptr;  // "inf" and "nan" are numbers, if wrong ones
  std::strtod(word.c_str(), &end);
  return end != word.c_str() && *end == '\0';
}

// Where the name of an image ends that a line begins with; 0 if there is none. It is what comes up
// to the first word with the extension of an image, or else a first word that begins with a letter.
std::size_t EndOfName(const std::string& line) {
  constexpr const char* kBlanks = " \t\r";
  std::size_t end_of_word = 0;
  for (std::size_t at = 0; at < line.size();) {
    const std::size_t begin = line.find_first_not_of(kBlanks, at);
    if (begin == std::string::npos) break;
    at = std::min(line.find_first_of(kBlanks, begin), line.size());
    std::string word = line.substr(begin, at - begin);
    const bool is_first = end_of_word == 0;
    if (is_first && (word[0] == '#' || IsNumber(word))) return 0;
    if (is_first && std::isalpha(static_cast<unsigned char>(word[0]))) end_of_word = at;
    if (is_first && end_of_word == 0) end_of_word = std::string::npos;  // '"', '/', ...
    if (word.ends_with('"')) word.pop_back();
    if (HasImageExtension(word)) return at;
  }
  return end_of_word == std::string::npos ? 0 : end_of_word;
}

// Folders of the name are dropped, those of Windows too.
std::optional<Line> ParseLine(const std::string& line) {
  Line parsed;
  const std::size_t end_of_name = EndOfName(line);
  if (end_of_name > 0) {
    const std::size_t begin = line.find_first_not_of(" \t\"");
    std::string name = line.substr(begin, end_of_name - begin);
    if (name.ends_with('"')) name.pop_back();
    parsed.image = name.substr(name.find_last_of("/\\") + 1);
  }
  const std::string rest = line.substr(end_of_name);
  const auto numbers = NumbersIn(rest.substr(0, rest.find('#')));
  if (!numbers) return std::nullopt;
  parsed.numbers = *numbers;
  return parsed;
}

void ReadIntensities(const std::filesystem::path& file, LightList& list) {
  std::istringstream text(WithoutBom(ReadWholeFile(file)));
  std::size_t next = 0;
  int line_number = 0;
  for (std::string line; std::getline(text, line);) {
    const std::string where = fmt::format("{}:{}", file.string(), ++line_number);
    const auto numbers = NumbersIn(line.substr(0, line.find('#')));
    if (numbers && numbers->empty()) continue;
    if (!numbers || (numbers->size() != 1 && numbers->size() != 3)) {
      throw InputError("{}: expected the intensity of a light, \"r g b\" or \"i\"", where);
    }
    if (next < list.lights.size()) {
      const std::vector<double>& n = *numbers;
      Color& irradiance = list.lights[next].irradiance;
      irradiance *= n.size() == 1 ? Color::Constant(n[0]) : Color(n[0], n[1], n[2]);
      if (!(irradiance > 0).all()) {
        throw InputError("{}: the intensity of a light must be above 0", where);
      }
    }
    ++next;
  }
  if (next != list.lights.size()) {
    throw InputError("{}: has {} intensities for {} lights; give one for each", file.string(), next,
                     list.lights.size());
  }
  list.has_intensities = true;
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

LightList ReadLights(const std::filesystem::path& file) {
  std::istringstream text(WithoutBom(ReadWholeFile(file)));
  LightList list;
  std::optional<double> announced;
  int line_number = 0;
  for (std::string line; std::getline(text, line);) {
    const std::string where = fmt::format("{}:{}", file.string(), ++line_number);
    const auto parsed = ParseLine(line);
    const std::size_t count = parsed ? parsed->numbers.size() : 0;
    if (parsed && parsed->image.empty() && count == 0) continue;
    if (count == 1 && parsed->image.empty() && list.lights.empty() && !announced) {
      announced = parsed->numbers.front();
      continue;
    }
    if (count != 3 && count != 4 && count != 6) {
      throw InputError(
          "{}: expected a light, \"x y z\", \"x y z i\" or \"x y z r g b\", with decimal points, "
          "after the name of its image or without one",
          where);
    }
    if (!list.lights.empty() && parsed->image.empty() != list.images.empty()) {
      throw InputError("{}: name the image in every line, or in none", where);
    }
    list.lights.push_back(LightFrom(parsed->numbers, where));
    list.has_intensities = list.has_intensities || count > 3;
    if (!parsed->image.empty()) list.images.push_back(parsed->image);
  }
  if (announced && *announced != static_cast<double>(list.lights.size())) {
    throw InputError("{}: the first line announces {} lights, {} follow; correct one of them",
                     file.string(), *announced, list.lights.size());
  }
  if (list.lights.empty()) throw InputError("{}: contains no lights", file.string());
  const auto intensities = file.parent_path() / "light_intensities.txt";
  if (file.filename() == "light_directions.txt" && std::filesystem::exists(intensities)) {
    ReadIntensities(intensities, list);
  }
  return list;
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
