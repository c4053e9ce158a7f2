#include "nerf/inspect/evidence.h"

#include <numbers>

#include "nerf/inspect/exif_stops.h"
#include "nerf/inspect/visual_hull.h"
#include "nerf/scene/photograph.h"

namespace nerf {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kNearby = 30 * kDegree;  // between photographs that should see the same

constexpr std::size_t kFewestPhotographs = 4;  // fewer are not evidence

// What is not known without sparse points; EXIF may still hold exposures.
void SetUnknown(const char* why, CaptureEvidence& evidence) {
  const ExifStops exif = ReadExifStops(*evidence.posed);
  evidence.stops = exif.stops;
  evidence.stops_source = "by their EXIF";
  evidence.warning = exif.contradiction;
  evidence.unknown_because = why;
}

}  // namespace

CaptureEvidence CollectEvidenceOfPhotographs(const PosedImages& photographs) {
  CheckMasks(photographs);
  CaptureEvidence evidence;
  evidence.posed = &photographs;
  evidence.facts = ExaminePhotographs(photographs);
  evidence.has_poses = false;
  SetUnknown("no poses yet to tell from", evidence);
  return evidence;
}

CaptureEvidence CollectEvidence(const PosedImages& posed, bool may_learn_background,
                                const std::function<void(int)>& read) {
  CheckMasks(posed);
  CaptureEvidence evidence;
  evidence.posed = &posed;
  evidence.may_learn_background = may_learn_background;
  evidence.facts = ExaminePhotographs(posed);
  evidence.frame = NormalizeScene(posed);
  evidence.has_points = posed.points.size() >= kFewestPoints;
  if (evidence.HasAlpha()) {
    evidence.hull = BoundingBallOfHull(posed, evidence.frame, read);
  } else if (evidence.has_points) {
    evidence.shares = SharesOfPoints(posed, evidence.frame);
  }
  if (!evidence.has_points || posed.images.size() < kFewestPhotographs) {
    SetUnknown("no sparse points to tell from", evidence);
    return evidence;
  }
  evidence.colors = ReadTrackColors(posed, kNearby, read);
  evidence.fit = FitPhotographs(evidence.colors.seen, posed.points.size(), posed.images.size());
  for (const auto& part : evidence.fit.of_photograph) {
    evidence.stops.push_back(static_cast<double>(part.mean()) / std::numbers::ln2);
  }
  evidence.stops_source = "in the same points";
  return evidence;
}

}  // namespace nerf
