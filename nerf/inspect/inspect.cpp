#include "nerf/inspect/inspect.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "nerf/config.h"
#include "nerf/data/camera.h"
#include "nerf/data/mask.h"
#include "nerf/inspect/exif_stops.h"
#include "nerf/inspect/photograph_facts.h"
#include "nerf/inspect/photograph_fit.h"
#include "nerf/inspect/track_colors.h"
#include "sfm/scene_normalization.h"

namespace nerf {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kNearby = 30 * kDegree;  // between photographs that should see the same

// Fewer points or photographs say too little.
constexpr std::size_t kFewestPoints = 50, kFewestPhotographs = 4, kFewestViews = 5;

// A normal distribution's standard deviation over its median absolute value.
constexpr double kDeviation = 1.48;

// From which on a scene calls for an effect.
constexpr double kExposureStops = 0.1;   // standard deviation over the photographs
constexpr double kViewDependent = 0.12;  // share of points
constexpr double kFlat = 0.05;      // log light, by which places without any texture may change
constexpr double kFarAway = 0.007;  // share of points beyond kFar
constexpr double kFar = 8;          // radii of what the cameras look at
constexpr double kPassing = 0.02;   // share of sightings that show something else
constexpr double kSomethingElse = 0.35;  // log light, and four times what is usual
constexpr double kNearest = 0.01;        // share of sightings that may be nearer than "the nearest"
constexpr double kShareOfTheWay = 0.7;   // to them, in which nothing stands
constexpr double kFewPhotographs = 15;   // before which a point stands
constexpr double kSteps = 2.0 / 255;     // spread of one colour, as files round it

double Luminance(const Eigen::Vector3f& log_light) { return static_cast<double>(log_light.mean()); }

Verdict Fact(const std::string& effect, bool on, double figure, const std::string& evidence,
             const std::string& setting = "{}") {
  Verdict verdict;
  verdict.effect = effect;
  verdict.evidence = evidence;
  verdict.figure = figure;
  verdict.decided = true;
  verdict.on = on;
  verdict.assignment = EffectAssignment(effect, on ? setting : "null");
  return verdict;
}

Verdict Measured(const std::string& effect, double figure, double threshold,
                 const std::string& evidence) {
  Verdict verdict = Fact(effect, figure >= threshold, figure, evidence);
  verdict.threshold = threshold;
  return verdict;
}

Verdict Undecided(const std::string& effect) {
  Verdict verdict;
  verdict.effect = effect;
  verdict.evidence = "no sparse points to tell from";
  return verdict;
}

Verdict NoBackground() { return Fact("background", false, 0, "photographs with alpha show none"); }

void AddFacts(const PhotographFacts& facts, std::vector<Verdict>& verdicts) {
  const bool alpha = facts.transparent > 0;
  verdicts.push_back(
      Fact("alpha", alpha, facts.transparent,
           alpha ? fmt::format("{:.0f} % of the pixels are transparent", 100 * facts.transparent)
                 : "no pixel is transparent"));
  verdicts.push_back(
      Fact("hdr", facts.linear, facts.beyond_white,
           facts.linear ? fmt::format("linear radiance, {:.1f} % of the pixels brighter than 1",
                                      100 * facts.beyond_white)
                        : "display-referred files"));
  // What was cut out is of one colour; what is to be ignored is a picture of something.
  const bool cut_out = facts.masked_spread < kSteps;
  verdicts.push_back(Fact(
      "masks", facts.masks > 0, facts.masks,
      facts.masks == 0 ? "no masks"
                       : fmt::format("{} of {} photographs have one, {:.1f} % masked out, which {}",
                                     facts.masks, facts.photographs, 100 * facts.masked_out,
                                     cut_out ? "has one colour: empty" : "shows things: ignore"),
      cut_out ? R"({"meaning": "empty"})" : R"({"meaning": "ignore"})"));
}

//   where  says what shows the exposures
Verdict JudgeExposure(const std::vector<double>& stops, const char* where) {
  double squares = 0, largest = 0;
  for (const double s : stops) {
    squares += s * s;
    largest = std::max(largest, std::fabs(s));
  }
  const double spread = std::sqrt(squares / static_cast<double>(stops.size()));
  return Measured("exposure", spread, kExposureStops,
                  fmt::format("photographs differ by {:.2f} stops ({:.2f} at most) {}; {:.2f} "
                              "call for it",
                              spread, largest, where, kExposureStops));
}

// The share of points whose colour changes from view to view by more than an error of a pixel, or
// another slant, could change it in their texture.
Verdict JudgeView(const TrackColors& colors, const PhotographFit& fit) {
  struct Spread {
    std::vector<double> left_over, contrast;
  };
  std::map<int, Spread> of_point;
  for (std::size_t i = 0; i < colors.seen.size(); ++i) {
    Spread& spread = of_point[colors.seen[i].point];
    spread.left_over.push_back(std::fabs(Luminance(fit.left_over[i])));
    spread.contrast.push_back(static_cast<double>(colors.seen[i].contrast));
  }
  std::size_t judged = 0, changing = 0;
  for (auto& [point, spread] : of_point) {
    if (spread.left_over.size() < kFewestViews) continue;
    ++judged;
    const double change = kDeviation * Quantile(spread.left_over, 0.5);
    if (change > kFlat + Quantile(spread.contrast, 0.5)) ++changing;
  }
  if (judged < kFewestPoints) {
    Verdict verdict = Undecided("view");
    verdict.evidence =
        fmt::format("only {} points are seen {} times and more", judged, kFewestViews);
    return verdict;
  }
  const double share = static_cast<double>(changing) / static_cast<double>(judged);
  return Measured("view", share, kViewDependent,
                  fmt::format("the colour of {:.1f} % of the points changes with the view by more "
                              "than their texture explains; {:.0f} % call for it",
                              100 * share, 100 * kViewDependent));
}

Verdict JudgePassers(const TrackColors& colors, const PhotographFit& fit) {
  std::vector<double> usual;
  for (const auto& left : fit.left_over) usual.push_back(std::fabs(Luminance(left)));
  const double noise = kDeviation * Quantile(usual, 0.5);
  const double limit = std::max(kSomethingElse, 4 * noise);
  std::size_t other = 0;
  for (const Sighting& s : colors.unseen) {
    const Eigen::Vector3f left =
        s.log_light - fit.of_point[s.point] - fit.of_photograph[s.photograph];
    if (static_cast<double>(left.cwiseAbs().maxCoeff()) > limit) ++other;
  }
  const double share = static_cast<double>(other) /
                       static_cast<double>(std::max<std::size_t>(1, colors.seen.size() + other));
  return Measured("robust", share, kPassing,
                  fmt::format("in {:.1f} % of the places where a point should be seen stands "
                              "something else; {:.0f} % call for it",
                              100 * share, 100 * kPassing));
}

Verdict JudgeBackground(const sfm::PosedImages& posed, bool alpha) {
  if (alpha) return NoBackground();
  const sfm::SceneNormalization normalized = sfm::NormalizeScene(posed);
  std::size_t far = 0;
  for (const sfm::SparsePoint& point : posed.points) {
    if (normalized.NormalizedFromWorld(point.x_in_world).norm() > kFar) ++far;
  }
  const double share = static_cast<double>(far) / static_cast<double>(posed.points.size());
  return Measured("background", share, kFarAway,
                  fmt::format("{:.1f} % of the points are more than {:.0f} radii away; {:.1f} % "
                              "call for it",
                              100 * share, kFar, 100 * kFarAway));
}

// Whether photographs alone leave open where matter stands.
Verdict JudgeDepth(const sfm::PosedImages& posed) {
  std::vector<double> photographs;
  for (const sfm::SparsePoint& point : posed.points) {
    int before = 0;
    for (const sfm::PosedImage& image : posed.images) {
      const sfm::Camera& camera = posed.cameras[image.camera];
      const auto pixel =
          PixelFromPoint(camera, image.world_from_camera.inverse() * point.x_in_world);
      before += pixel && pixel->x() >= 0 && pixel->y() >= 0 && pixel->x() < camera.width &&
                pixel->y() < camera.height;
    }
    photographs.push_back(before);
  }
  const double median = Quantile(photographs, 0.5);
  Verdict verdict =
      Fact("depth", median < kFewPhotographs, median,
           fmt::format("a point stands before {:.0f} photographs; fewer than {:.0f} call for it",
                       median, kFewPhotographs));
  verdict.threshold = kFewPhotographs;
  return verdict;
}

// Where rays may begin: whatever stands nearer to a camera than most of the way to the nearest
// points is fog that nobody has seen.
Verdict JudgeNear(const sfm::PosedImages& posed) {
  const sfm::SceneNormalization normalized = sfm::NormalizeScene(posed);
  std::vector<double> distances;
  for (const sfm::SparsePoint& point : posed.points) {
    for (const sfm::TrackElement& seen : point.track) {
      const Eigen::Vector3d camera = posed.images[seen.image].world_from_camera.translation();
      distances.push_back(normalized.scale * (point.x_in_world - camera).norm());
    }
  }
  const double nearest = Quantile(distances, kNearest);
  const double near = std::clamp(kShareOfTheWay * nearest, MarchOptions().near_distance, kFar);
  Verdict verdict = Fact("near", near > MarchOptions().near_distance, near,
                         fmt::format("the nearest points are {:.2f} radii before a camera, so rays "
                                     "begin at {:.2f}",
                                     nearest, near));
  verdict.assignment = fmt::format("{}={:.3f}", kNearKey, near);
  return verdict;
}

}  // namespace

Inspection Inspect(const sfm::PosedImages& posed, const std::function<void(int)>& read) {
  CheckMasks(posed);
  Inspection inspection;
  const PhotographFacts facts = LookAtPhotographs(posed);
  AddFacts(facts, inspection.verdicts);
  if (posed.points.size() < kFewestPoints || posed.images.size() < kFewestPhotographs) {
    const ExifStops exif = ReadExifStops(posed);
    inspection.stops = exif.stops;
    inspection.warning = exif.contradiction;
    inspection.verdicts.push_back(Undecided("view"));
    inspection.verdicts.push_back(facts.transparent > 0 ? NoBackground() : Undecided("background"));
    inspection.verdicts.push_back(exif.stops.empty() ? Undecided("exposure")
                                                     : JudgeExposure(exif.stops, "by their EXIF"));
    inspection.verdicts.push_back(Undecided("robust"));
    inspection.verdicts.push_back(Undecided("depth"));
    return inspection;
  }
  const TrackColors colors = ReadTrackColors(posed, kNearby, read);
  const PhotographFit fit = FitPhotographs(colors.seen, posed.points.size(), posed.images.size());
  for (const auto& part : fit.of_photograph) {
    inspection.stops.push_back(Luminance(part) / std::numbers::ln2);
  }
  inspection.verdicts.push_back(JudgeView(colors, fit));
  inspection.verdicts.push_back(JudgeBackground(posed, facts.transparent > 0));
  inspection.verdicts.push_back(JudgeExposure(inspection.stops, "in the same points"));
  inspection.verdicts.push_back(JudgePassers(colors, fit));
  inspection.verdicts.push_back(JudgeDepth(posed));
  inspection.verdicts.push_back(JudgeNear(posed));
  return inspection;
}

}  // namespace nerf
