#include "sfm/reconstruction_verdict.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <set>

#include "nerf/base/quantile.h"
#include "nerf/scene/scene_normalization.h"
#include "sfm/pair_selection.h"
#include "sfm/pose_error.h"

namespace nerf::sfm {
namespace {

// docs/poses.md has the captures with known poses on which these were chosen.
constexpr double kMaxError = 4;                              // pixels
constexpr int kStrongest = 6;                                // pairs of each photograph
constexpr double kFits = 0.85, kHardlyFits = 0.65;           // share of the matches
constexpr double kMisplaced = 0.8;                           // of the matches of a photograph
constexpr double kFewMisplaced = 0.1, kManyMisplaced = 0.3;  // of the photographs
constexpr double kFewObservations = 60;                      // in a photograph
constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
constexpr double kNarrow = 2.5;            // degrees
constexpr long kSharedToCompare = 8;       // photographs
constexpr double kMostDisagreement = 1.5;  // degrees
constexpr double kFarRadius = 8, kMostFar = 0.5;

double LargestAngle(const PosedImages& model, const SparsePoint& point) {
  double smallest_cosine = 1;
  for (std::size_t i = 0; i < point.track.size(); ++i) {
    const auto ray = [&](std::size_t k) -> Eigen::Vector3d {
      const PosedImage& image = model.images[point.track[k].image];
      return (point.x_in_world - image.world_from_camera.translation()).normalized();
    };
    for (std::size_t j = i + 1; j < point.track.size(); ++j) {
      smallest_cosine = std::min(smallest_cosine, ray(i).dot(ray(j)));
    }
  }
  return std::acos(std::clamp(smallest_cosine, -1.0, 1.0)) * 180 / std::numbers::pi;
}

ReconstructionFigures FiguresOf(const PosedImages& model, std::span<const SeenTwice> matches) {
  ReconstructionFigures figures;
  figures.registered = static_cast<int>(model.images.size());
  figures.points = static_cast<int>(model.points.size());
  std::vector<double> observations(model.images.size(), 0.0), angles;
  const SceneNormalization normalized = NormalizeScene(model);
  for (const SparsePoint& point : model.points) {
    for (const TrackElement& element : point.track) ++observations[element.image];
    figures.track_length += static_cast<double>(point.track.size()) / figures.points;
    angles.push_back(LargestAngle(model, point));
    const bool is_far = normalized.NormalizedFromWorld(point.x_in_world).norm() > kFarRadius;
    figures.far += (is_far ? 1.0 : 0.0) / figures.points;
  }
  figures.observations = observations.empty() ? 0 : Median(observations);
  figures.angle = angles.empty() ? 0 : Median(angles);
  int all = 0, fitting = 0;
  const std::vector<ImageFit> fits = FitOfImages(model, matches, kMaxError);
  for (const ImageFit& fit : fits) {
    all += fit.matches;
    fitting += fit.fitting;
    const auto image = static_cast<int>(&fit - fits.data());
    if (fit.fitting < kMisplaced * fit.matches) figures.misplaced.push_back(image);
  }
  figures.fitting = all > 0 ? static_cast<double>(fitting) / all : kUnknown;
  return figures;
}

}  // namespace

std::vector<SeenTwice> MatchesOf(const PosedImages& model, const ColmapDatabase& database) {
  std::map<std::string, int> image_of;
  for (std::size_t i = 0; i < model.images.size(); ++i) {
    image_of[model.images[i].name] = static_cast<int>(i);
  }
  std::vector<int> image(database.Names().size(), -1);
  std::vector<std::vector<Eigen::Vector2f>> positions(image.size());
  for (std::size_t i = 0; i < image.size(); ++i) {
    const auto found = image_of.find(database.Names()[i]);
    if (found == image_of.end()) continue;
    image[i] = found->second;
    positions[i] = database.ReadFeatures(static_cast<int>(i)).positions;
  }
  std::vector<std::pair<ImagePair, int>> verified = database.VerifiedPairs();
  std::erase_if(verified, [&](const auto& entry) {
    return image[entry.first.first] < 0 || image[entry.first.second] < 0;
  });
  std::vector<SeenTwice> strongest;
  for (const ImagePair& pair :
       MostSimilarPairs(verified, static_cast<int>(image.size()), kStrongest, 0)) {
    SeenTwice seen{{image[pair.first], image[pair.second]}, {}, {}};
    for (const FeatureMatch& match : database.ReadVerified(pair)) {
      seen.in_first.push_back(positions[pair.first][match.first].cast<double>());
      seen.in_second.push_back(positions[pair.second][match.second].cast<double>());
    }
    strongest.push_back(std::move(seen));
  }
  return strongest;
}

ReconstructionVerdict JudgeReconstruction(const PosedImages& model,
                                          std::span<const SeenTwice> matches) {
  ReconstructionVerdict verdict;
  verdict.figures = FiguresOf(model, matches);
  if (matches.empty()) return verdict;
  const ReconstructionFigures& f = verdict.figures;
  const auto worsen = [&](Trust trust, const std::string& reason) {
    verdict.trust = std::max(verdict.trust, trust);
    verdict.reason += (verdict.reason.empty() ? "" : "; ") + reason;
  };
  if (f.fitting < kFits) {
    worsen(f.fitting < kHardlyFits ? Trust::kBroken : Trust::kDoubtful,
           fmt::format("only {:.0f} % of the matches fit the poses: repeated patterns, mirrors or "
                       "moving things may mislead; photograph from closer steps",
                       100 * f.fitting));
  }
  const auto misplaced = static_cast<double>(f.misplaced.size());
  if (misplaced > kFewMisplaced * f.registered) {
    worsen(misplaced > kManyMisplaced * f.registered ? Trust::kBroken : Trust::kDoubtful,
           fmt::format("{} photographs are probably misplaced; take more between them",
                       f.misplaced.size()));
  }
  if (f.observations < kFewObservations) {
    worsen(Trust::kDoubtful,
           fmt::format("half of the photographs see fewer than {:.0f} points; use sharp "
                       "photographs of surfaces with texture, or put something with texture "
                       "beside them",
                       kFewObservations));
  }
  verdict.features_may_help = verdict.trust != Trust::kGood;
  if (f.angle < kNarrow) {
    worsen(Trust::kDoubtful, fmt::format("the rays to half of the points differ by less than {} "
                                         "degrees; move the camera, do not only turn it",
                                         kNarrow));
  }
  if (f.far > kMostFar) {
    worsen(Trust::kDoubtful,
           fmt::format("{:.0f} % of the points are far away from what the cameras "
                       "look at",
                       100 * f.far));
  }
  return verdict;
}

void JudgeAgreement(const PosedImages& model, std::span<const PosedImages> others,
                    ReconstructionVerdict& verdict) {
  double& disagreement = verdict.figures.disagreement;
  for (const PosedImages& other : others) {
    std::set<std::string> names;
    for (const PosedImage& image : other.images) names.insert(image.name);
    const auto shared = std::ranges::count_if(
        model.images, [&](const PosedImage& image) { return names.contains(image.name); });
    if (shared < kSharedToCompare) continue;
    disagreement = std::max(disagreement, ComparePosesByName(other, model).rotation_median);
  }
  if (disagreement <= kMostDisagreement) return;
  verdict.trust = std::max(verdict.trust, Trust::kDoubtful);
  verdict.reason += fmt::format(
      "{}photographs stand {:.1f} degrees from where a smaller reconstruction has them: its parts "
      "were joined by few matches; take more photographs between them",
      verdict.reason.empty() ? "" : "; ", disagreement);
}

PosedImages WithoutImages(const PosedImages& model, const std::vector<int>& images) {
  PosedImages rest = model;
  rest.images.clear();
  rest.points.clear();
  std::vector<int> number(model.images.size(), -1);
  for (int i = 0; i < static_cast<int>(model.images.size()); ++i) {
    if (std::ranges::binary_search(images, i)) continue;
    number[i] = static_cast<int>(rest.images.size());
    rest.images.push_back(model.images[i]);
  }
  for (SparsePoint point : model.points) {
    std::erase_if(point.track, [&](const TrackElement& e) { return number[e.image] < 0; });
    for (TrackElement& element : point.track) element.image = number[element.image];
    if (point.track.size() >= 2) rest.points.push_back(std::move(point));
  }
  return rest;
}

std::string_view NameOf(Trust trust) {
  switch (trust) {
    case Trust::kGood:
      return "good";
    case Trust::kDoubtful:
      return "doubtful";
    default:
      return "broken";
  }
}

std::string Describe(const ReconstructionVerdict& verdict) {
  const ReconstructionFigures& f = verdict.figures;
  if (std::isnan(f.fitting)) return "there are no matches to judge them by";
  std::string text = fmt::format(
      "{}: {:.0f} % of the matches fit the poses, {:.0f} points in a photograph, each in {:.1f} "
      "photographs, seen at angles of {:.0f} degrees",
      NameOf(verdict.trust), 100 * f.fitting, f.observations, f.track_length, f.angle);
  return verdict.reason.empty() ? text : text + "; " + verdict.reason;
}

}  // namespace nerf::sfm
