#include "sfm/colmap_runner.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <regex>

#include "nerf/base/input_error.h"
#include "sfm/colmap_images.h"
#include "sfm/colmap_steps.h"

namespace nerf::sfm {
namespace {

namespace fs = std::filesystem;

constexpr int kSequenceMin = 100;    // "auto": more than this, numbered, are matched in sequence
constexpr int kExhaustiveMost = 20;  // and no more than this all with all
constexpr int kFewestRegistered = 4;
constexpr double kFewestFraction = 0.1;
constexpr double kWarnFraction = 0.9;

const char* const kAdvice =
    "take more photographs that overlap (each part of the scene in five or more), sharp, of things "
    "with texture, with one lens and exposure";

std::string Listed(const std::vector<std::string>& names) {
  constexpr std::size_t kShown = 8;
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), kShown); ++i) {
    text += (i > 0 ? ", " : "") + names[i];
  }
  if (names.size() > kShown) text += fmt::format(" and {} more", names.size() - kShown);
  return text;
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
  const std::vector<fs::path> files = ListPhotos(photo_folder);
  ColmapReport ignored;
  ColmapReport& r = report != nullptr ? *report : ignored;

  PhotoFolder folder = CheckPhotos(files, options.threads);
  r.photos = static_cast<int>(folder.photos.size());
  r.skipped = folder.skipped;
  for (const SkippedPhoto& skipped : r.skipped) {
    spdlog::warn("{}: skipped: {}", skipped.name, skipped.reason);
  }
  const std::vector<ColmapImage> plan = PlanColmapImages(folder.photos);
  std::vector<std::string> names;
  for (const Photo& photo : folder.photos) names.push_back(photo.name);
  const bool one_size = plan.front().name.find('/') == std::string::npos;
  std::string matcher = options.matcher;
  if (matcher == "auto") {
    const bool sequence = one_size && r.photos > kSequenceMin && IsNumberedSequence(names);
    matcher = sequence ? "sequential" : r.photos <= kExhaustiveMost ? "exhaustive" : "guided";
  }
  // COLMAP's lists of pairs know no names with spaces, and take a '#' for a comment.
  const auto unlistable = [](const ColmapImage& image) {
    return image.name.starts_with('#') ||
           std::ranges::any_of(image.name, [](unsigned char c) { return std::isspace(c) != 0; });
  };
  if (const auto found = std::ranges::find_if(plan, unlistable);
      matcher == "guided" && found != plan.end()) {
    spdlog::warn(
        "{}: guided matching knows no names with spaces or '#' in front; all pairs are "
        "compared, which takes longer",
        found->name);
    matcher = "exhaustive";
  }

  ColmapSteps steps(workspace, options, r.photos);
  steps.PrepareImages(files, folder.photos, plan);
  steps.ExtractFeatures();
  steps.Match(matcher);
  steps.Map();
  if (matcher == "guided" && steps.Registered() < kWarnFraction * r.photos) {
    spdlog::info("{} of {} registered; the pairs that were left out are compared, too",
                 steps.Registered(), r.photos);
    steps.MatchAllAndMap();
  }
  if (2 * steps.Registered() < r.photos) {
    spdlog::info("{} of {} registered; the mapper tries again with lower thresholds",
                 steps.Registered(), r.photos);
    steps.MapRelaxed();
  }
  r.seconds = steps.Seconds();
  r.registered = steps.Registered();
  if (r.registered < kFewestRegistered || r.registered < kFewestFraction * r.photos) {
    throw InputError("{}: COLMAP registered {} of {} photographs, too few to go on: {}{}; see {}",
                     photo_folder.string(), r.registered, r.photos, kAdvice,
                     matcher == "sequential" ? "; or try --matcher exhaustive" : "",
                     steps.LogFile("mapper").parent_path().string());
  }

  PosedImages result = steps.ReadModel();
  std::map<std::string, const Photo*> photo_of;
  for (const ColmapImage& image : plan) photo_of[image.name] = &folder.photos[image.photo];
  for (PosedImage& image : result.images) {
    const auto found = photo_of.find(image.name);
    if (found == photo_of.end()) {
      throw InputError("{}: names {}, which is none of the photographs; remove {} and start again",
                       result.source.string(), image.name, workspace.string());
    }
    const Photo& photo = *found->second;
    image.name = photo.name;
    image.path = photo.path;
    image.upright_by_exif = photo.orientation != 1;
    photo_of.erase(found);
  }
  for (const auto& [name, photo] : photo_of) r.unregistered.push_back(photo->name);
  std::sort(r.unregistered.begin(), r.unregistered.end());
  r.points = static_cast<int>(result.points.size());
  for (const SparsePoint& point : result.points) {
    r.mean_reprojection_error += point.reprojection_error / static_cast<double>(r.points);
  }
  if (r.registered < kWarnFraction * r.photos) {
    spdlog::warn("COLMAP registered {} of {} photographs, not {}: {}", r.registered, r.photos,
                 Listed(r.unregistered), kAdvice);
  }
  return result;
}

}  // namespace nerf::sfm
