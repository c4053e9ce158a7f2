#include "nerf/field/pose_refinement.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "nerf/config/config.h"
#include "nerf/model/refined_poses.h"
#include "nerf/pipeline/held_out_halves.h"
#include "nerf/render/ray_gradient.h"
#include "nerf/synthetic/sample_folder.h"
#include "nerf/train/trainer.h"
#include "nerf/train/validation.h"
#include "sfm/colmap_model.h"
#include "sfm/transforms_json.h"
#include "tests/support/central_differences.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/small_capture.h"
#include "tests/support/two_engines.h"

namespace nerf {
namespace {

using Eigen::Vector3d;

std::vector<CameraPlace> Ring(int count, int lenses = 1) {
  std::vector<CameraPlace> places;
  for (int i = 0; i < count; ++i) {
    const double a = 2.4 * i;
    const Vector3d centre(2 * std::cos(a), 2 * std::sin(a), 0.4 + 0.2 * std::sin(3.0 * i));
    places.push_back({centre, -centre.normalized(), i % lenses});
  }
  return places;
}

// Sets a random refinement of every photograph and lens.
void Perturb(PoseRefinement& poses, double size) {
  const torch::NoGradGuard no_grad;
  torch::manual_seed(4);
  for (torch::Tensor& p : poses.parameters()) p.normal_(0.0, size);
}

test::TwoEngines WithPoses(double size, bool with_proposal = false,
                           std::shared_ptr<Background> background = nullptr) {
  test::TwoEngines e;
  e.pose_refinement = std::make_shared<PoseRefinement>(Ring(3, 2), PoseRefinementOptions());
  e.background = std::move(background);
  Perturb(*e.pose_refinement, size);
  e.Make(60, with_proposal);
  return e;
}

TEST(PoseRefinement, ChangesNoBitBeforeTraining) {
  test::TwoEngines off;
  off.Make(60);
  const test::TwoEngines neutral = WithPoses(0);
  for (const auto engine : {&test::TwoEngines::libtorch, &test::TwoEngines::fused}) {
    const StepResult a = (off.*engine)->AccumulateGradients(off.batch);
    const StepResult b = (neutral.*engine)->AccumulateGradients(neutral.batch);
    EXPECT_EQ(a.loss, b.loss);
    EXPECT_EQ(a.ray_error, b.ray_error);
  }
}

TEST(PoseRefinement, IsTheSameInBothEngines) {
  WithPoses(0.2).ExpectTheSame();
  WithPoses(0.2, true).ExpectTheSame();
}

TEST(PoseRefinement, WorksWithALearnedBackground) {
  const auto background = std::make_shared<Background>(BackgroundOptions{8}, ColorEncoding::kSrgb);
  WithPoses(0.2, false, background).ExpectTheSame();
}

TEST(PoseRefinement, RotatesRaysAboutTheirCamerasAndTranslatesThem) {
  PoseRefinement poses(Ring(12), PoseRefinementOptions{1.0});
  Perturb(poses, 0.3);
  const torch::NoGradGuard no_grad;
  const auto places = Ring(12);
  for (std::int64_t i = 0; i < 12; ++i) {
    Eigen::Isometry3d camera = Eigen::Isometry3d::Identity();
    camera.translation() = places[i].centre;
    camera.linear() =
        Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), places[i].axis).toRotationMatrix();
    const Eigen::Isometry3d refined = poses.Refined(i, camera);
    // The same pixel with the focal length scaled by the lens's factor.
    const double f = std::exp(poses.LogFocals()[0].item<double>());
    const Vector3d before = camera.linear() * Vector3d(0.3, -0.2, 1).normalized();
    const Vector3d after = refined.linear() * Vector3d(0.3, -0.2, f).normalized();
    const auto row = [](const Vector3d& v) {
      return torch::tensor({{v.x(), v.y(), v.z()}}, torch::kFloat);
    };
    const RefinedRays moved =
        poses.forward(row(camera.translation()), row(before), torch::full({1}, i, torch::kLong));
    EXPECT_LT((moved.origin - row(refined.translation())).abs().max().item<double>(), 1e-6);
    EXPECT_LT((moved.direction - row(after)).abs().max().item<double>(), 1e-5);
  }
}

TEST(PoseRefinement, ProjectsOutSimilaritiesOfTheWholeScene) {
  const auto places = Ring(9);
  PoseRefinement poses(places, PoseRefinementOptions{1.0});
  const auto remainder_of = [&](const std::function<void(Vector3d, float*)>& move) {
    const torch::NoGradGuard no_grad;
    torch::Tensor twist = poses.parameters()[0];
    twist.zero_();
    Vector3d mean = Vector3d::Zero();
    for (const CameraPlace& place : places) mean += place.centre / 9;
    for (int i = 0; i < 9; ++i) move(places[i].centre - mean, twist[i].data_ptr<float>());
    return poses.Twists().abs().max().item<double>();
  };
  EXPECT_LT(remainder_of([](Vector3d, float* t) { t[4] = 1; }), 1e-5);
  EXPECT_LT(remainder_of([](Vector3d arm, float* t) {
              for (int c = 0; c < 3; ++c) t[3 + c] = static_cast<float>(arm[c]);
            }),
            1e-5);
  EXPECT_LT(remainder_of([](Vector3d arm, float* t) {
              const Vector3d shift = Vector3d::UnitZ().cross(arm);
              t[2] = 1;
              for (int c = 0; c < 3; ++c) t[3 + c] = static_cast<float>(shift[c]);
            }),
            1e-5);
  EXPECT_GT(remainder_of([](Vector3d arm, float* t) { t[3] = static_cast<float>(arm.y()); }), 0.1);
}

TEST(PoseRefinement, CanRotateCamerasInOnePoint) {
  std::vector<CameraPlace> places = Ring(5);
  for (CameraPlace& place : places) place.centre.setZero();
  PoseRefinement poses(places, PoseRefinementOptions{1.0});
  Perturb(poses, 0.1);
  const torch::Tensor twist = poses.Twists();
  EXPECT_TRUE(torch::isfinite(twist).all().item<bool>());
  EXPECT_GT(twist.slice(1, 0, 3).abs().max().item<double>(), 0.01);
  EXPECT_LT(twist.slice(1, 0, 3).mean(0).abs().max().item<double>(), 1e-6);
}

// From the refinement through rays, contraction, encoding and networks to density and colour.
TEST(PoseRefinement, GradientsMatchCentralDifferences) {
  test::TwoEngines e = WithPoses(0.2);
  e.field->to(torch::kDouble);
  e.pose_refinement->to(torch::kDouble);
  const std::int64_t count = 12, each = 6;
  const auto of = [&](const std::vector<float>& values) {
    return torch::from_blob(const_cast<float*>(values.data()), {count, 3}).to(torch::kDouble);
  };
  const torch::Tensor ray = torch::arange(count).repeat_interleave(each);
  // Inside and outside the unit ball.
  const torch::Tensor t = (torch::arange(count * each, torch::kDouble) * 0.77).remainder(4.0) + 0.3;
  const torch::Tensor photograph = torch::arange(count).remainder(3);
  const auto f = [&] {
    const RefinedRays moved =
        e.pose_refinement->forward(of(e.batch.rays.origin), of(e.batch.rays.direction), photograph);
    const FieldOutput out = e.field->forward(SamplePositions(moved.origin, moved.direction, ray, t),
                                             of(e.batch.rays.direction), ray);
    return (out.sigma.log1p() * torch::arange(count * each, torch::kDouble).cos()).sum() +
           out.radiance.square().sum();
  };
  for (torch::Tensor parameter : e.pose_refinement->parameters()) {
    test::ExpectGradientMatchesCentralDifferences(f, parameter, 1e-7, 2e-5);
  }
}

// Held-out photographs share lenses with training photographs, and use the refined focal lengths.
TEST(PoseRefinement, OfLensesAppliesToHeldOutPhotographs) {
  const test::SmallCapture capture = test::MakeSmallCapture(9, 24, 18);
  Config config = test::SmallConfig();
  config.effects.pose_refinement.emplace();
  const test::ScratchFolder run;
  Trainer trainer(config, capture.scene, capture.data, run.path());
  trainer.TakeSteps(50);
  const Model& model = trainer.GetModel();
  const auto set_focal = [&](double factor) {
    const torch::NoGradGuard no_grad;
    model.pose_refinement->named_parameters()["log_focal"].fill_(
        std::log(factor) / config.effects.pose_refinement->rate);
  };
  constexpr double kFactor = 1.1;
  std::vector<View> held_out = {capture.data.train.front()};
  held_out[0].name = "held out";
  std::vector<View> longer = held_out;
  for (int i = 0; i < 2; ++i) longer[0].camera.params[i] *= kFactor;
  set_focal(1);
  const double as_given = Validation(held_out, 1).Psnr(model, false);
  const double through_longer = Validation(longer, 1).Psnr(model, false);
  set_focal(kFactor);
  EXPECT_NEAR(Validation(held_out, 1).Psnr(model, false), through_longer, 1e-4);
  EXPECT_GT(std::fabs(as_given - through_longer), 1e-3);

  PosedImages posed;
  posed.cameras = {held_out.front().camera};
  const Camera camera = RefinedPoses(model, posed).cameras.front();
  EXPECT_NEAR(camera.params[0], longer.front().camera.params[0], 1e-3);
}

// A generated capture with wrong poses: training refines them towards the true ones.
TEST(PoseRefinement, IsFoundByTraining) {
  const test::ScratchFolder folder;
  synthetic::SampleOptions options;
  options.scenario = synthetic::Scenario::kPoseRefinement;
  options.views = 24;
  options.width = 120;
  options.height = 90;
  options.samples_per_pixel = 4;
  synthetic::WriteSample(folder.path(), options);
  const PosedImages truth = sfm::ReadTransformsJson(folder.path() / "truth/poses.json");
  PosedImages posed =
      sfm::ReadColmapModel(folder.path() / "truth/sparse", folder.path() / "images");
  for (std::size_t i = 0; i < posed.images.size(); ++i) {
    posed.images[i].split = i % 8 == 0 ? Split::kValidation : Split::kTrain;
  }
  const SceneNormalization frame = NormalizeScene(posed);
  Dataset data = LoadDataset(posed, {}, {}, frame);
  const std::vector<View> with_right_poses = data.validation;
  const HeldOutHalves halves(data);
  const test::ScratchFolder run;
  const auto trained = [&](const std::string& poses) {
    const Config config = LoadConfig(
        "fast", {"march.near_distance=1", "train.steps=500", "effects.pose_refinement=" + poses});
    return std::make_unique<Trainer>(config, FactsOf(data, frame), data, run.path());
  };
  const auto refining = trained("{}"), fixed = trained("null");
  refining->TakeSteps(500);
  fixed->TakeSteps(500);

  std::vector<double> before, after;
  const PoseRefinement& poses = *refining->GetModel().pose_refinement;
  for (std::size_t i = 0; i < data.train.size(); ++i) {
    const auto named = std::ranges::find(truth.images, data.train[i].name, &PosedImage::name);
    ASSERT_NE(named, truth.images.end());
    const auto degrees_off = [&](const Eigen::Isometry3d& pose) {
      const Eigen::Matrix3d turn =
          frame.NormalizedFromCamera(named->world_from_camera).linear().transpose() * pose.linear();
      return Eigen::AngleAxisd(turn).angle() * 180 / std::numbers::pi;
    };
    const Eigen::Isometry3d& given = data.train[i].normalized_from_camera;
    before.push_back(degrees_off(given));
    after.push_back(degrees_off(poses.Refined(static_cast<std::int64_t>(i), given)));
  }
  std::ranges::sort(before);
  std::ranges::sort(after);
  EXPECT_GT(before[before.size() / 2], 0.3);
  // The remaining error is seven tenths of a pixel of these small photographs.
  EXPECT_LT(after[after.size() / 2], 0.75 * before[before.size() / 2]);
  const auto psnr = [&](const std::unique_ptr<Trainer>& trainer) {
    return Validation(with_right_poses, 1).Psnr(trainer->GetModel(), true);
  };
  EXPECT_GT(psnr(refining), psnr(fixed) + 1);
  // As a trial measures it, without true poses.
  EXPECT_GT(refining->ValidationPsnrAtOwnExposure(), fixed->ValidationPsnrAtOwnExposure() + 1);
}

}  // namespace
}  // namespace nerf
