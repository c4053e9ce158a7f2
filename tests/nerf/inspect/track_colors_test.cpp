#include "nerf/inspect/track_colors.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "nerf/synthetic/sample_folder.h"
#include "sfm/colmap_model.h"
#include "tests/support/scratch_folder.h"

namespace nerf {
namespace {

constexpr double kNearby = 0.6;  // radians
constexpr int kPhotograph = 5;   // in which the point is hidden

std::size_t UnseenBy(const PosedImages& posed, int photograph) {
  const std::vector<Sighting> unseen = ReadTrackColors(posed, kNearby).unseen;
  return static_cast<std::size_t>(std::ranges::count(unseen, photograph, &Sighting::photograph));
}

// Forgets that a photograph sees the points that `forget` names.
template <class Forget>
void Blind(PosedImages& posed, const Forget& forget) {
  for (int p = 0; p < static_cast<int>(posed.points.size()); ++p) {
    std::erase_if(posed.points[p].track,
                  [&](const TrackElement& seen) { return forget(p, seen.image); });
  }
}

// Of the photographs that see a point, the one that looks most nearly from where another does.
int NeighbourOf(const PosedImages& posed, int point) {
  const auto& track = posed.points[point].track;
  const auto nearest = std::ranges::min_element(track, {}, [&](const TrackElement& seen) {
    return AngleAt(posed, point, kPhotograph, seen.image);
  });
  return nearest == track.end() ? -1 : nearest->image;
}

TEST(TrackColors, APointThatTheNeighbourObservesIsUnseen) {
  const test::ScratchFolder folder;
  synthetic::SampleOptions options;
  options.scenario = synthetic::Scenario::kNothing;
  options.views = 30;
  options.width = 120;
  options.height = 90;
  options.samples_per_pixel = 1;
  synthetic::WriteSample(folder.path(), options);
  PosedImages posed =
      sfm::ReadColmapModel(folder.path() / "truth" / "sparse", folder.path() / "images");
  EXPECT_LT(UnseenBy(posed, kPhotograph), 3u);

  // A passer-by in front of this camera only.
  Blind(posed, [](int, int image) { return image == kPhotograph; });
  const std::size_t missed = UnseenBy(posed, kPhotograph);
  EXPECT_GT(missed, 50u);

  // What hides a point from the neighbour too is of the scene.
  std::vector<int> neighbours;
  for (int p = 0; p < static_cast<int>(posed.points.size()); ++p) {
    neighbours.push_back(NeighbourOf(posed, p));
  }
  Blind(posed, [&](int point, int image) { return image == neighbours[point]; });
  EXPECT_LT(UnseenBy(posed, kPhotograph), missed / 20);
}

}  // namespace
}  // namespace nerf
