#include "nerf/scene/output_names.h"

#include <spdlog/fmt/fmt.h>

#include <filesystem>
#include <map>
#include <set>

#include "nerf/base/text.h"

namespace nerf {
namespace {

namespace fs = std::filesystem;

std::string Joined(const fs::path& path) {
  std::string name;
  for (const fs::path& part : path.relative_path()) {
    if (part == "..") continue;
    if (!name.empty()) name += '_';
    name += part.string();
  }
  return name;
}

std::string WithoutExtension(const std::string& image) {
  return Joined(fs::path(image).replace_extension());
}

std::string WithExtension(const std::string& image) {
  const std::string extension = fs::path(image).extension().string();
  if (extension.empty()) return WithoutExtension(image);
  return fmt::format("{}_{}", WithoutExtension(image), extension.substr(1));
}

}  // namespace

std::vector<std::string> OutputNames(const std::vector<PosedImage>& images) {
  std::map<std::string, int> count;
  for (const PosedImage& image : images) ++count[Lowercase(WithoutExtension(image.name))];
  std::vector<std::string> names;
  std::set<std::string> taken;
  // Names that only one image can have come first, so that no other takes them.
  for (const PosedImage& image : images) {
    names.push_back(WithoutExtension(image.name));
    if (count[Lowercase(names.back())] == 1) taken.insert(Lowercase(names.back()));
  }
  for (std::size_t i = 0; i < images.size(); ++i) {
    if (count[Lowercase(names[i])] == 1) continue;
    const std::string name = WithExtension(images[i].name);
    names[i] = name;
    for (int number = 2; !taken.insert(Lowercase(names[i])).second; ++number) {
      names[i] = fmt::format("{}_{}", name, number);
    }
  }
  return names;
}

}  // namespace nerf
