#include "nerf/effects/depth_supervision.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "nerf/image/image_io.h"
#include "nerf/render/view_renderer.h"
#include "nerf/scene/pixel_sampler.h"
#include "nerf/synthetic/sample_folder.h"
#include "sfm/colmap_model.h"
#include "tests/support/analytic_capture.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/tiny_training.h"
#include "tests/support/two_engines.h"

namespace nerf {
namespace {

// A capture of few photographs, of which every eighth is for validation.
struct FewPhotographs {
  test::ScratchFolder folder;
  PosedImages sparse;
  SceneNormalization normalized_from_world;
  Dataset data;

  FewPhotographs() {
    synthetic::SampleOptions options;
    options.scenario = synthetic::Scenario::kDepthSupervision;
    options.views = 10;
    options.width = 96;
    options.height = 72;
    options.samples_per_pixel = 4;
    synthetic::WriteSample(folder.path(), options);
    sparse = sfm::ReadColmapModel(folder.path() / "truth/sparse", folder.path() / "images");
    for (std::size_t i = 0; i < sparse.images.size(); ++i) {
      sparse.images[i].split = i % 8 == 0 ? Split::kValidation : Split::kTrain;
    }
    normalized_from_world = NormalizeScene(sparse);
    data = LoadDataset(sparse, {}, {}, normalized_from_world);
    AddSparseDepths(sparse, normalized_from_world, data);
  }
};

// Both engines with a batch in which every other ray has a known distance.
test::TwoEngines WithDistances(const std::optional<DepthSupervisionOptions>& depth) {
  test::TwoEngines e;
  e.depth = depth;
  e.Make(50);
  for (int r = 0; r < 50; ++r) {
    e.batch.distance.push_back(r % 2 ? 0.0f : 1.0f + 0.5f * std::sin(static_cast<float>(r)));
  }
  return e;
}

TEST(DepthLoss, OfASampleGrowsWithItsRelativeErrorAndIsBounded) {
  const DepthSupervisionOptions options = {0.1, 2.0, 0.1};
  EXPECT_EQ(DepthCost(3, 3, options), 0);
  EXPECT_NEAR(DepthCost(3.3, 3, options), 0.5, 1e-12);
  EXPECT_NEAR(DepthCost(2.7, 3, options), 0.5, 1e-12);
  EXPECT_GT(DepthCost(0, 3, options), 0.99);
  EXPECT_LT(DepthCost(1e6, 3, options), 1);
  const std::vector<float> t = {3, 0, 7};
  const std::vector<std::int64_t> ray = {0, 0, 1};
  const std::vector<float> target = {3, 0};  // the second ray has no target
  EXPECT_EQ(DepthCosts(t, ray, target, options), (std::vector<float>{0, 1 / 1.01f, 0}));
}

TEST(DepthLoss, IsTheSameInBothEngines) {
  for (const double weight : {0.1, 3.0}) {
    test::TwoEngines e = WithDistances(DepthSupervisionOptions{0.1, weight, 0.05});
    e.ExpectTheSame();
  }
}

TEST(DepthLoss, WithWeightZeroChangesNothing) {
  const test::TwoEngines off = WithDistances({}),
                         zero = WithDistances(DepthSupervisionOptions{0.1, 0, 0.05}),
                         on = WithDistances(DepthSupervisionOptions{0.1, 1, 0.05});
  for (const auto engine : {&test::TwoEngines::libtorch, &test::TwoEngines::fused}) {
    const double loss = (off.*engine)->AccumulateGradients(off.batch).loss;
    EXPECT_EQ((zero.*engine)->AccumulateGradients(zero.batch).loss, loss);
    EXPECT_GT((on.*engine)->AccumulateGradients(on.batch).loss, loss);
  }
}

// The true distance of each pixel of a view, normalized units.
std::vector<double> TrueDistances(const FewPhotographs& few, const View& view) {
  const std::string stem = view.name.substr(0, view.name.find('.'));
  const Image depth =
      ReadImage(few.folder.path() / "truth" / (stem + ".depth.exr"), /*upright=*/false);
  std::vector<double> distances;
  for (std::size_t i = 0; i < depth.pixels.size(); i += depth.channels) {
    distances.push_back(few.normalized_from_world.scale * static_cast<double>(depth.pixels[i]));
  }
  return distances;
}

TEST(SparseDepths, AreTheDistancesOfTheirPixels) {
  const FewPhotographs few;
  std::size_t points = 0, wrong = 0;
  for (const View& view : few.data.train) {
    const std::vector<double> truth = TrueDistances(few, view);
    for (const DepthObservation& point : view.depth_observations) {
      const double expected = truth[point.pixel];
      ++points;
      // Pixels are large here: at an edge the centre of a pixel can show another surface.
      wrong += std::fabs(static_cast<double>(point.distance) / expected - 1) > 0.05;
    }
  }
  EXPECT_GT(points, 1000u);
  EXPECT_LT(wrong, points / 10);
  for (const View& view : few.data.validation) EXPECT_TRUE(view.depth_observations.empty());
}

TEST(SparseDepths, AreSampledWithTheConfiguredShare) {
  const FewPhotographs few;
  const TargetBatch batch = PixelSampler(few.data.train, 0, 0.25).Sample(4000, 3, 7);
  ASSERT_EQ(batch.distance.size(), 4000u);
  const auto known = 4000 - std::ranges::count(batch.distance, 0.0f);
  EXPECT_NEAR(static_cast<double>(known), 1000, 140);  // five standard deviations
  // With a share of zero, the same rays are drawn as without points.
  Dataset plain = few.data;
  for (View& view : plain.train) view.depth_observations.clear();
  const TargetBatch with = PixelSampler(few.data.train).Sample(500, 3, 7),
                    without = PixelSampler(plain.train).Sample(500, 3, 7);
  EXPECT_EQ(with.rays.direction, without.rays.direction);
  EXPECT_TRUE(with.distance.empty());
}

// The median relative error of a model's depth in validation views.
double DistanceError(const Model& model, const FewPhotographs& few) {
  std::vector<double> errors;
  for (const View& view : few.data.validation) {
    const std::vector<double> truth = TrueDistances(few, view);
    std::vector<std::int64_t> pixels;
    for (std::int64_t k = 0; k < view.StoredCount(); k += 3) pixels.push_back(k);
    const RayBatch rays =
        RaysOfPixels(view.camera, view.normalized_from_camera, pixels, Eigen::Vector3f::Zero())
            .rays;
    const RenderOutput seen = MakeRenderer(model)->Render(rays);
    for (std::size_t r = 0; r < pixels.size(); ++r) {
      const double expected = truth[pixels[r]];
      errors.push_back(std::fabs(static_cast<double>(seen.depth[r]) / expected - 1));
    }
  }
  std::ranges::nth_element(errors, errors.begin() + errors.size() / 2);
  return errors[errors.size() / 2];
}

TEST(SparseDepths, ImproveDepthWherePhotographsAreFew) {
  const FewPhotographs few;
  const SceneFacts scene = FactsOf(few.data, few.normalized_from_world);
  const auto error = [&](const std::string& effect) {
    const Config config = LoadConfig("fast", {"march.near_distance=1.1", "train.steps=400",
                                              "effects.depth_supervision=" + effect});
    return DistanceError(test::Trained(config, scene, few.data), few);
  };
  const double without = error("null"), with = error("{}");
  EXPECT_LT(with, 0.8 * without);
}

}  // namespace
}  // namespace nerf
