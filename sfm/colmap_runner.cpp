#include "sfm/colmap_runner.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <map>
#include <regex>

#include "nerf/base/input_error.h"
#include "sfm/colmap_images.h"
#include "sfm/reconstruction.h"

namespace nerf::sfm {
namespace {

namespace fs = std::filesystem;

// Matcher "auto": more photographs than kSequenceMin, if numbered, are matched in sequence; at most
// kExhaustiveMost are matched exhaustively.
constexpr std::size_t kSequenceMin = 100, kExhaustiveMost = 20;
constexpr int kFewestRegistered = 4;
constexpr double kFewestFraction = 0.1;
constexpr double kWarnFraction = 0.9;

const char* const kAdvice =
    "take more photographs that overlap (each part of the scene in at least five) and are sharp, "
    "of "
    "textured surfaces, with one lens and exposure";

std::string Listed(const std::vector<std::string>& names) {
  constexpr std::size_t kShown = 8;
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), kShown); ++i) {
    text += (i > 0 ? ", " : "") + names[i];
  }
  if (names.size() > kShown) text += fmt::format(" and {} more", names.size() - kShown);
  return text;
}

std::string ChooseMatcher(const std::string& wanted, const std::vector<Photo>& photos,
                          const std::vector<ColmapImage>& plan) {
  if (wanted != "auto") return wanted;
  std::vector<std::string> names;
  for (const Photo& photo : photos) names.push_back(photo.name);
  const bool one_size = plan.front().name.find('/') == std::string::npos;
  const bool sequence = one_size && photos.size() > kSequenceMin && IsNumberedSequence(names);
  return sequence ? "sequential" : photos.size() <= kExhaustiveMost ? "exhaustive" : "guided";
}

// Replaces COLMAP's images in `posed` by the original photographs.
//   returns  the names of the photographs that are not registered, sorted
std::vector<std::string> RestorePhotographs(const std::vector<Photo>& photos,
                                            const std::vector<ColmapImage>& plan,
                                            const fs::path& workspace, PosedImages& posed) {
  std::map<std::string, const Photo*> photo_of;
  for (const ColmapImage& image : plan) photo_of[image.name] = &photos[image.photo];
  for (PosedImage& image : posed.images) {
    const auto found = photo_of.find(image.name);
    if (found == photo_of.end()) {
      throw InputError("{}: contains {}, which is none of the photographs; remove {} and run again",
                       posed.source.string(), image.name, workspace.string());
    }
    const Photo& photo = *found->second;
    image.name = photo.name;
    image.path = photo.path;
    image.upright_by_exif = photo.orientation != 1;
    photo_of.erase(found);
  }
  std::vector<std::string> unregistered;
  for (const auto& [name, photo] : photo_of) unregistered.push_back(photo->name);
  std::ranges::sort(unregistered);
  return unregistered;
}

void WarnAbout(const ColmapReport& report) {
  if (report.misplaced > 0) {
    spdlog::warn(
        "{} photographs that COLMAP registered are left out: their matches contradict "
        "their poses",
        report.misplaced);
  }
  if (report.largest_broken > report.registered) {
    spdlog::warn("a model of {} photographs is not trusted; one of {} is taken instead",
                 report.largest_broken, report.registered);
  }
  if (report.verdict.trust != Trust::kGood) {
    spdlog::warn("the poses are {}: {}", NameOf(report.verdict.trust), report.verdict.reason);
  }
  if (report.registered < kWarnFraction * report.photos) {
    spdlog::warn("COLMAP registered {} of {} photographs, not {}; {}", report.registered,
                 report.photos, Listed(report.unregistered), kAdvice);
  }
}

}  // namespace

bool IsNumberedSequence(const std::vector<std::string>& names) {
  if (names.empty()) return false;
  static const std::regex numbered(R"(^(.*?)(\d{1,12})(\D*)$)");
  std::smatch first, match;
  if (!std::regex_match(names.front(), first, numbered)) return false;
  std::int64_t lowest = 0, highest = 0;
  for (const std::string& name : names) {
    if (!std::regex_match(name, match, numbered) || match[1] != first[1] || match[3] != first[3] ||
        match[2].length() != first[2].length()) {
      return false;
    }
    const std::int64_t number = std::stoll(match[2]);
    if (&name == &names.front()) lowest = number;
    highest = number;
  }
  return highest - lowest < 2 * static_cast<std::int64_t>(names.size());
}

PosedImages PosesFromPhotos(const fs::path& photo_folder, const fs::path& workspace,
                            const ColmapOptions& options, ColmapReport* report) {
  options.Check();
  const std::vector<PhotoFile> files = ListPhotos(photo_folder);
  if (const std::string text = DescribeSubFolders(files); !text.empty()) {
    spdlog::warn("{}: {}", photo_folder.string(), text);
  }
  ColmapReport ignored;
  ColmapReport& r = report != nullptr ? *report : ignored;

  PhotoFolder folder = CheckPhotos(files, options.threads);
  SkipDuplicates(folder);
  r.photos = static_cast<int>(folder.photos.size());
  r.skipped = folder.skipped;
  for (const SkippedPhoto& skipped : r.skipped) {
    spdlog::warn("{}: skipped: {}", skipped.name, skipped.reason);
  }
  const std::vector<ColmapImage> plan = PlanColmapImages(folder.photos);
  const std::string matcher = ChooseMatcher(options.matcher, folder.photos, plan);
  Reconstruction found = Reconstruct(workspace, options, files, folder.photos, plan, matcher);
  PosedImages& posed = found.posed;
  r.seconds = found.seconds;
  r.verdict = found.verdict;
  r.misplaced = found.misplaced;
  r.largest_broken = found.largest_broken;
  r.registered = static_cast<int>(posed.images.size());
  if (r.registered < kFewestRegistered || r.registered < kFewestFraction * r.photos) {
    throw InputError("{}: COLMAP registered only {} of {} photographs; {}{}; see {}",
                     photo_folder.string(), r.registered, r.photos, kAdvice,
                     matcher == "sequential" ? "; or try --matcher exhaustive" : "",
                     found.log.string());
  }

  r.unregistered = RestorePhotographs(folder.photos, plan, workspace, posed);
  r.points = static_cast<int>(posed.points.size());
  for (const SparsePoint& point : posed.points) {
    r.mean_reprojection_error += point.reprojection_error / static_cast<double>(r.points);
  }
  WarnAbout(r);
  return posed;
}

}  // namespace nerf::sfm
