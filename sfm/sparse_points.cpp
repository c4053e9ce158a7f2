#include "sfm/sparse_points.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string>

#include "nerf/base/input_error.h"
#include "nerf/base/parallel.h"
#include "nerf/base/stopwatch.h"
#include "nerf/image/image_convert.h"
#include "nerf/scene/photograph.h"
#include "sfm/colmap_images.h"
#include "sfm/colmap_steps.h"
#include "sfm/feature_tracks.h"
#include "sfm/photo_folder.h"
#include "sfm/triangulation.h"

namespace nerf::sfm {
namespace {

namespace fs = std::filesystem;

constexpr int kExhaustiveMost = 20;  // photographs of which all pairs are matched
// Around a feature nothing may be transparent: its descriptor would be of the background.
constexpr int kOpaqueRadius = 2;
constexpr float kOpaque = 0.5f;

// COLMAP's names are numbers, since names of an input may be of any form: "./train/r_0".
std::vector<PhotoFile> NumberedFiles(const PosedImages& posed) {
  std::vector<PhotoFile> files;
  for (std::size_t i = 0; i < posed.images.size(); ++i) {
    const fs::path& path = posed.images[i].path;
    files.push_back({fmt::format("{:06}{}", i, path.extension().string()), fs::absolute(path)});
  }
  return files;
}

int NumberOf(const std::string& name) { return std::stoi(name); }

// The photographs as their cameras see them: turned by EXIF only where these are.
std::vector<Photo> PhotosOf(const PosedImages& posed, const std::vector<PhotoFile>& files,
                            int threads) {
  std::vector<Photo> photos = CheckPhotos(files, threads).photos;
  for (Photo& photo : photos) {
    if (!posed.images[NumberOf(photo.name)].upright_by_exif) photo.orientation = 1;
  }
  return photos;
}

// The features of one photograph, in the pixels of its camera.
struct PhotoFeatures {
  std::vector<Eigen::Vector2d> pixels;
  std::vector<std::optional<std::array<std::uint8_t, 3>>> rgb;  // nothing: no feature of the scene
};

bool IsOpaqueAround(const Image& image, int x, int y) {
  if (image.channels < 4) return true;
  for (int v = std::max(0, y - kOpaqueRadius); v <= std::min(image.height - 1, y + kOpaqueRadius);
       ++v) {
    for (int u = std::max(0, x - kOpaqueRadius); u <= std::min(image.width - 1, x + kOpaqueRadius);
         ++u) {
      const std::size_t pixel = static_cast<std::size_t>(v) * image.width + u;
      if (image.pixels[4 * pixel + 3] < kOpaque) return false;
    }
  }
  return true;
}

// Throws InputError as LoadPhotograph does, also where the photograph has not the size of its
// camera.
PhotoFeatures LookAt(const PosedImages& posed, int image,
                     const std::vector<Eigen::Vector2f>& positions) {
  const Photograph photograph =
      LoadPhotograph(posed, posed.images[image], {1, MaskMeaning::kEmpty});
  const Image& pixels = photograph.pixels;
  PhotoFeatures found;
  for (const Eigen::Vector2f& position : positions) {
    found.pixels.push_back(position.cast<double>());
    const int x = std::clamp(static_cast<int>(found.pixels.back().x()), 0, pixels.width - 1);
    const int y = std::clamp(static_cast<int>(found.pixels.back().y()), 0, pixels.height - 1);
    found.rgb.emplace_back();
    if (!IsOpaqueAround(pixels, x, y)) continue;
    const std::size_t at = (static_cast<std::size_t>(y) * pixels.width + x) * pixels.channels;
    std::array<std::uint8_t, 3> rgb{};
    for (int c = 0; c < 3; ++c) {
      rgb[c] = static_cast<std::uint8_t>(std::clamp(255 * pixels.pixels[at + c], 0.0f, 255.0f));
    }
    found.rgb.back() = rgb;
  }
  return found;
}

// What matching has found, in terms of the given images.
struct Matched {
  std::vector<int> image_of;            // database index -> index of posed.images
  std::vector<PhotoFeatures> features;  // by database index
  std::vector<std::pair<ImagePair, std::vector<FeatureMatch>>> pairs;  // of database indices

  std::vector<SeenTwice> Sightings() const {
    std::vector<SeenTwice> seen;
    for (const auto& [pair, matches] : pairs) {
      SeenTwice both{{image_of[pair.first], image_of[pair.second]}, {}, {}};
      for (const FeatureMatch& match : matches) {
        both.in_first.push_back(features[pair.first].pixels[match.first]);
        both.in_second.push_back(features[pair.second].pixels[match.second]);
      }
      seen.push_back(std::move(both));
    }
    return seen;
  }
};

Matched ReadMatched(const PosedImages& posed, const std::vector<Photo>& photos,
                    const std::vector<ColmapImage>& plan, const ColmapDatabase& database,
                    int threads) {
  std::map<std::string, const Photo*> photo_of;
  for (const ColmapImage& image : plan) photo_of[image.name] = &photos[image.photo];
  Matched matched;
  std::vector<std::vector<Eigen::Vector2f>> positions;
  for (std::size_t i = 0; i < database.Names().size(); ++i) {
    const auto photo = photo_of.find(database.Names()[i]);
    if (photo == photo_of.end()) {
      throw InputError(
          "{}: has features of {}, which is none of the photographs; remove the folder "
          "for points and run again",
          posed.source.string(), database.Names()[i]);
    }
    matched.image_of.push_back(NumberOf(photo->second->name));
    positions.push_back(database.ReadFeatures(static_cast<int>(i)).positions);
  }
  matched.features.resize(positions.size());
  ParallelForEach(
      std::ssize(positions),
      [&](std::int64_t i) {
        matched.features[i] = LookAt(posed, matched.image_of[i], positions[i]);
      },
      threads);
  for (const auto& verified : database.VerifiedPairs()) {
    const auto& pair = verified.first;  // no binding: clang 14 does not capture it
    std::vector<FeatureMatch> matches = database.ReadVerified(pair);
    std::erase_if(matches, [&](const FeatureMatch& match) {
      return !matched.features[pair.first].rgb[match.first] ||
             !matched.features[pair.second].rgb[match.second];
    });
    matched.pairs.emplace_back(pair, std::move(matches));
  }
  return matched;
}

// The mean colour of the features of a track.
std::array<std::uint8_t, 3> ColorOf(const Matched& matched, const FeatureTrack& track) {
  std::array<int, 3> sum{};
  for (const auto& [image, feature] : track) {
    for (int c = 0; c < 3; ++c) sum[c] += (*matched.features[image].rgb[feature])[c];
  }
  std::array<std::uint8_t, 3> mean{};
  for (int c = 0; c < 3; ++c) {
    mean[c] = static_cast<std::uint8_t>(sum[c] / static_cast<int>(track.size()));
  }
  return mean;
}

std::vector<SparsePoint> TriangulateAll(const PosedImages& posed, const Matched& matched,
                                        int threads) {
  std::vector<int> counts;
  for (const PhotoFeatures& features : matched.features) {
    counts.push_back(static_cast<int>(features.pixels.size()));
  }
  const std::vector<FeatureTrack> tracks =
      BuildTracks(matched.pairs, counts, TriangulationOptions().min_views);
  std::vector<std::optional<SparsePoint>> found(tracks.size());
  ParallelForEach(
      std::ssize(tracks),
      [&](std::int64_t i) {
        std::vector<TrackElement> track;
        for (const auto& [image, feature] : tracks[i]) {
          track.push_back({matched.image_of[image], matched.features[image].pixels[feature]});
        }
        found[i] = Triangulate(posed, track);
        if (found[i]) found[i]->rgb = ColorOf(matched, tracks[i]);
      },
      threads);
  std::vector<SparsePoint> points;
  for (auto& point : found) {
    if (point) points.push_back(std::move(*point));
  }
  return points;
}

}  // namespace

SparsePointReport FindSparsePoints(PosedImages& posed, const fs::path& workspace,
                                   const ColmapOptions& options) {
  const Stopwatch watch;
  options.Check();
  const std::vector<PhotoFile> files = NumberedFiles(posed);
  const std::vector<Photo> photos = PhotosOf(posed, files, options.threads);
  const std::vector<ColmapImage> plan = PlanColmapImages(photos);
  ColmapSteps steps(workspace, options, static_cast<int>(photos.size()));
  steps.PrepareImages(files, photos, plan);
  steps.ExtractFeatures();
  steps.Match(std::ssize(photos) <= kExhaustiveMost ? "exhaustive" : "guided");
  const Matched matched =
      ReadMatched(posed, photos, plan, ColmapDatabase(steps.Database()), options.threads);
  SparsePointReport report;
  report.consistency = CheckPoses(posed, matched.Sightings());
  posed.points.clear();
  if (!report.consistency.Contradicts()) {
    posed.points = TriangulateAll(posed, matched, options.threads);
  }
  report.points = static_cast<int>(posed.points.size());
  for (const SparsePoint& point : posed.points) {
    report.track_length += static_cast<double>(point.track.size()) / report.points;
    report.mean_reprojection_error += point.reprojection_error / report.points;
  }
  report.seconds = watch.Seconds();
  return report;
}

std::string Describe(const SparsePointReport& report) {
  return fmt::format(
      "{} sparse points, each in {:.1f} photographs, reprojection error {:.2f} px, {:.0f} s",
      report.points, report.track_length, report.mean_reprojection_error, report.seconds);
}

}  // namespace nerf::sfm
