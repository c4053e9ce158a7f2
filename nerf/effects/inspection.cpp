#include "nerf/effects/inspection.h"

#include <spdlog/fmt/fmt.h>

#include <numbers>
#include <optional>

#include "nerf/effects/color_verdicts.h"
#include "nerf/effects/geometry_verdicts.h"
#include "nerf/image/mask.h"
#include "nerf/inspect/exif_stops.h"
#include "nerf/inspect/photograph_facts.h"
#include "nerf/inspect/photograph_fit.h"
#include "nerf/inspect/track_colors.h"
#include "nerf/inspect/visual_hull.h"
#include "nerf/scene/photograph.h"

namespace nerf {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kNearby = 30 * kDegree;  // between photographs that should see the same

constexpr std::size_t kFewestPhotographs = 4;  // fewer say too little
constexpr double kSteps = 2.0 / 255;           // spread of one colour, as files round it

Verdict NoBackground() { return Fact("background", false, 0, "photographs with alpha show none"); }

void AddFacts(const PhotographFacts& facts, std::vector<Verdict>& verdicts) {
  const bool alpha = facts.transparent > 0;
  verdicts.push_back(
      Fact("alpha", alpha, facts.transparent,
           alpha ? fmt::format("{:.0f} % of the pixels are transparent", 100 * facts.transparent)
                 : "no pixel is transparent"));
  verdicts.push_back(
      Fact("hdr", facts.linear, facts.above_white,
           facts.linear ? fmt::format("linear radiance, {:.1f} % of the pixels brighter than 1",
                                      100 * facts.above_white)
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

// What cannot be told without sparse points; of exposures, EXIF may tell.
void AddUndecided(const PosedImages& posed, bool alpha, const std::string& why,
                  Inspection& inspection) {
  const ExifStops exif = ReadExifStops(posed);
  inspection.stops = exif.stops;
  inspection.warning = exif.contradiction;
  std::vector<Verdict>& verdicts = inspection.verdicts;
  verdicts.push_back(Undecided("view", why));
  verdicts.push_back(alpha ? NoBackground() : Undecided("background", why));
  verdicts.push_back(exif.stops.empty() ? Undecided("exposure", why)
                                        : JudgeExposure(exif.stops, "by their EXIF"));
  for (const char* effect : {"robust", "depth", "poses", "footprint"}) {
    verdicts.push_back(Undecided(effect, why));
  }
}

}  // namespace

Inspection InspectPhotographs(const PosedImages& photographs) {
  CheckMasks(photographs);
  const PhotographFacts facts = ExaminePhotographs(photographs);
  constexpr char kWhy[] = "no poses yet to tell from";
  Inspection inspection;
  AddFacts(facts, inspection.verdicts);
  inspection.verdicts.push_back(Undecided("unbounded", kWhy));
  AddUndecided(photographs, facts.transparent > 0, kWhy, inspection);
  return inspection;
}

Inspection Inspect(const PosedImages& posed, const std::function<void(int)>& read, bool learned) {
  CheckMasks(posed);
  Inspection inspection;
  const PhotographFacts facts = ExaminePhotographs(posed);
  AddFacts(facts, inspection.verdicts);
  const bool alpha = facts.transparent > 0;
  const SceneNormalization frame = NormalizeScene(posed);
  inspection.normalized_from_world = frame;
  PointShares shares;
  if (alpha) {
    const std::optional<Ball> hull = BoundingBallOfHull(posed, frame, read);
    inspection.verdicts.push_back(JudgeUnbounded(hull));
    if (!inspection.verdicts.back().on)
      inspection.normalized_from_world = NormalizedTo(*hull, frame);
  } else if (posed.points.size() < kFewestPoints) {
    inspection.verdicts.push_back(
        Fact("unbounded", true, 0, "photographs without alpha show surroundings"));
  } else {
    shares = SharesOfPoints(posed, frame);
    inspection.verdicts.push_back(JudgeUnbounded(shares, learned));
    const bool bounded = !inspection.verdicts.back().on;
    if (bounded) inspection.normalized_from_world = NormalizedTo(shares.near, frame);
  }
  if (posed.points.size() < kFewestPoints || posed.images.size() < kFewestPhotographs) {
    AddUndecided(posed, alpha, "no sparse points to tell from", inspection);
    return inspection;
  }
  const TrackColors colors = ReadTrackColors(posed, kNearby, read);
  const PhotographFit fit = FitPhotographs(colors.seen, posed.points.size(), posed.images.size());
  for (const auto& part : fit.of_photograph) {
    inspection.stops.push_back(static_cast<double>(part.mean()) / std::numbers::ln2);
  }
  inspection.residuals = ResidualsByAngle(posed, colors, fit);
  inspection.verdicts.push_back(JudgeView(colors, fit));
  inspection.verdicts.push_back(alpha ? NoBackground() : JudgeBackground(shares));
  inspection.verdicts.push_back(JudgeExposure(inspection.stops, "in the same points"));
  inspection.verdicts.push_back(JudgePassers(colors, fit));
  inspection.verdicts.push_back(JudgeDepth(posed, frame));
  inspection.verdicts.push_back(JudgePoses(posed));
  inspection.verdicts.push_back(JudgeFootprint(posed));
  inspection.verdicts.push_back(JudgeNear(posed, inspection.normalized_from_world));
  return inspection;
}

}  // namespace nerf
