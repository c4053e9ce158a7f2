#include "nerf/capture/olat_pictures.h"

#include <algorithm>
#include <cctype>
#include <iterator>
#include <sstream>
#include <string>
#include <utility>

#include "nerf/base/atomic_file.h"
#include "nerf/base/input_error.h"
#include "nerf/base/text.h"
#include "nerf/image/image_files.h"

namespace nerf {
namespace {

namespace fs = std::filesystem;

constexpr const char* kListName = "filenames.txt";

bool HasMaskInName(const fs::path& file) {
  return Lowercase(file.stem().string()).find("mask") != std::string::npos;
}

bool IsGroundTruth(const fs::path& file) {
  return Lowercase(file.stem().string()).starts_with("normal_gt");
}

// Natural order: numbers in names are compared by value, so that "cat.2.tga" is before
// "cat.10.tga".
bool NaturalLess(const fs::path& left, const fs::path& right) {
  const std::string a = left.filename().string();
  const std::string b = right.filename().string();
  const auto is_digit = [](char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; };
  std::size_t i = 0;
  std::size_t j = 0;
  while (i < a.size() && j < b.size()) {
    if (!is_digit(a[i]) || !is_digit(b[j])) {
      if (a[i] != b[j]) return a[i] < b[j];
      ++i, ++j;
      continue;
    }
    const auto number = [&](const std::string& text, std::size_t& at) {
      const std::size_t begin = text.find_first_not_of('0', at);
      while (at < text.size() && is_digit(text[at])) ++at;
      return begin < at ? text.substr(begin, at - begin) : std::string();
    };
    const std::string m = number(a, i);
    const std::string n = number(b, j);
    if (m != n) return m.size() != n.size() ? m.size() < n.size() : m < n;
  }
  return std::pair(a.size() - i, a) < std::pair(b.size() - j, b);
}

// Reads the list NAME.txt of the images in the folder NAME, in order.
std::vector<fs::path> ReadImageList(const fs::path& list, const fs::path& folder) {
  std::istringstream text(WithoutBom(ReadWholeFile(list)));
  std::vector<fs::path> files;
  for (std::string line; std::getline(text, line);) {
    while (!line.empty() && std::isspace(static_cast<unsigned char>(line.back()))) line.pop_back();
    if (!HasImageExtension(line)) continue;  // the first line counts them
    const fs::path name = fs::path(line).filename();
    auto file = FindImageFile(folder / name);
    if (!file) file = FindImageFile(folder / name.stem());  // raw files that were developed
    if (!file) {
      throw InputError("{}: lists {}, which does not exist in {}", list.string(), line,
                       folder.string());
    }
    files.push_back(*file);
  }
  return files;
}

}  // namespace

std::vector<fs::path> OlatPicturesIn(const fs::path& folder) {
  std::vector<fs::path> files = ImageFilesIn(folder);
  std::erase_if(files, IsGroundTruth);
  std::ranges::sort(files, NaturalLess);
  return files;
}

OlatPictures FindOlatPictures(const fs::path& folder) {
  OlatPictures pictures;
  const std::vector<fs::path> all = OlatPicturesIn(folder);
  // Where every name has the word, it is of the subject: a carnival mask.
  const bool names_tell = !std::ranges::all_of(all, HasMaskInName);
  const auto is_mask = [&](const fs::path& file) {
    return names_tell ? HasMaskInName(file) : Lowercase(file.stem().string()) == "mask";
  };
  std::ranges::copy_if(all, std::back_inserter(pictures.masks), is_mask);
  for (const fs::path& list :
       {folder / kListName, folder.parent_path() / (folder.filename().string() + ".txt")}) {
    if (pictures.images.empty() && fs::is_regular_file(list)) {
      pictures.images = ReadImageList(list, folder);
    }
  }
  if (pictures.images.empty()) pictures.images = all;
  std::erase_if(pictures.images, is_mask);
  return pictures;
}

}  // namespace nerf
