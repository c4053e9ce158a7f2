#include "nerf/pipeline/material_training.h"

#include <gtest/gtest.h>

#include <atomic>
#include <fstream>

#include "nerf/model/materials_file.h"
#include "nerf/model/run_folder.h"
#include "nerf/pipeline/training_session.h"
#include "nerf/synthetic/relightable_folder.h"
#include "sfm/transforms_json.h"
#include "tests/support/scratch_folder.h"

namespace nerf {
namespace {

// A field of a small capture under two named lights, and a plan that gives one of them a sun and
// leaves the other unknown.
class MaterialTrainingOfAField : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new test::ScratchFolder;
    synthetic::RelightableOptions options;
    options.views = 12;
    options.test_views = 1;
    options.width = options.height = 48;
    options.paths = 16;
    options.lights = 2;
    synthetic::WriteRelightable(folder_->path() / "capture", options, [] { return true; });
    TrainingRequest request;
    request.input = folder_->path() / "capture" / "transforms_train.json";
    request.run = folder_->path() / "run";
    request.preset = "fast";
    request.preset_is_given = true;
    request.assignments = {"train.steps=150", "train.representation=field"};
    request.effects.inspect = false;
    const std::atomic<bool> stop = false;
    TrainingSession(request, Stopwatch(), IgnoreEvents).Run(stop);
  }
  static void TearDownTestSuite() { delete folder_; }

  // Materials by some steps, stopped after `stop_after` of them where it is above 0.
  static std::optional<MaterialsFound> Find(const std::filesystem::path& to, bool resume,
                                            std::int64_t stop_after) {
    std::filesystem::create_directories(to);
    const OpenedRun run = OpenRun(folder_->path() / "run");
    const PosedImages posed = sfm::ReadTransformsJson(PosesPath(folder_->path() / "run"));
    const Dataset data = LoadDataset(posed, run.model->GetConfig().data, {},
                                     run.model->Scene().normalized_from_world);
    MaterialPlan plan;
    plan.options.steps = 60;
    plan.options.surface_resolution = 32;
    plan.options.directions = 64;
    plan.options.points = 64;
    plan.options.specular = plan.options.shadows = LightEffectChoice::kOff;
    plan.run = to;
    plan.resume = resume;
    if (!resume) {  // a fit that is resumed goes on as it was planned
      plan.options.directions = 32;
      PlannedLight unknown, sun;
      unknown.name = "sunny";
      unknown.has_unknown_environment = true;
      sun.name = "lamps";
      sun.environment = EnvironmentMap::Uniform({0.5, 0.5, 0.5});
      sun.suns = {DirectionalLight{Eigen::Vector3d(0, 0, 1), {1, 1, 1}}};
      plan.lights = LightPlan{{unknown, sun}, {}};
    }
    std::atomic<bool> stop = false;
    return TrainMaterials(*run.model, posed, data, plan, stop, [&](const PipelineEvent& event) {
      const auto* stepped = std::get_if<MaterialsStepped>(&event);
      if (stepped != nullptr && stop_after > 0 && stepped->step >= stop_after) stop = true;
    });
  }

  inline static test::ScratchFolder* folder_ = nullptr;
};

TEST_F(MaterialTrainingOfAField, InterruptedAndResumedGivesTheSameBits) {
  const auto whole = folder_->path() / "whole", parts = folder_->path() / "parts";
  const auto found = Find(whole, false, 0);
  ASSERT_TRUE(found && found->finished);
  EXPECT_EQ(found->lights, 2u);
  EXPECT_TRUE(found->is_relative);
  EXPECT_TRUE(std::filesystem::exists(whole / "environment_sunny.exr"));

  const auto stopped = Find(parts, false, 20);
  ASSERT_TRUE(stopped);
  EXPECT_FALSE(stopped->finished);
  EXPECT_TRUE(ReadInterruptedMaterials(MaterialsPath(parts)));
  const auto resumed = Find(parts, true, 0);
  ASSERT_TRUE(resumed && resumed->finished);
  EXPECT_EQ(resumed->steps, 60);
  EXPECT_FALSE(ReadInterruptedMaterials(MaterialsPath(parts)));

  const Materials a = ReadMaterials(MaterialsPath(whole)), b = ReadMaterials(MaterialsPath(parts));
  const auto of_a = a.surface.field->parameters(), of_b = b.surface.field->parameters();
  for (std::size_t i = 0; i < of_a.size(); ++i) EXPECT_TRUE(torch::equal(of_a[i], of_b[i])) << i;
  for (std::size_t g = 0; g < 2; ++g) {
    EXPECT_TRUE(torch::equal(a.surface.lights[g].environment, b.surface.lights[g].environment));
    EXPECT_EQ(a.surface.lights[g].lamps.size(), b.surface.lights[g].lamps.size());
  }
}

TEST_F(MaterialTrainingOfAField, AFitThatHasEndedStays) {
  const auto folder = folder_->path() / "ended";
  ASSERT_TRUE(Find(folder, false, 0)->finished);
  const auto again = Find(folder, true, 0);
  ASSERT_TRUE(again);
  EXPECT_TRUE(again->finished);
  EXPECT_EQ(again->steps, 60);
}

}  // namespace
}  // namespace nerf
