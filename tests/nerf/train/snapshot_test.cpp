#include "nerf/model/snapshot.h"

#include <gtest/gtest.h>

#include <map>
#include <mutex>
#include <thread>
#include <vector>

#include "nerf/base/parallel.h"
#include "nerf/model/run_folder.h"
#include "nerf/train/trainer.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/small_capture.h"
#include "tests/support/tiny_training.h"

namespace nerf {
namespace {

// A configuration with every module: proposal network, background, exposure, pose refinement.
Config EveryModule(std::int64_t steps) {
  return test::TinyConfig(steps, {"march.sampler=proposal", "effects.background={}",
                                  "effects.exposure={}", "effects.pose_refinement={}"});
}

ViewRequest FirstView(const test::SmallCapture& small, double quality = 1) {
  const PosedImages& posed = small.capture.posed;
  return {posed.cameras[0], posed.images[0].world_from_camera, quality};
}

// Four threads render while a fifth trains. Each picture is bit for bit that of its snapshot's step
// in a second training with the same seed: no picture mixes two steps.
TEST(ModelSnapshot, RendersConsistentlyFromFourThreadsDuringTraining) {
  SetNumThreads(2);
  const test::SmallCapture small = test::MakeSmallCapture(10, 24, 18);
  const Config config = EveryModule(60);
  const test::ScratchFolder run;
  std::map<std::int64_t, std::vector<std::vector<float>>> pictures;  // by step
  std::mutex mutex;
  {
    Trainer trainer(config, small.scene, small.data, run.path());
    std::atomic<bool> finished = false;
    const auto view_snapshots = [&] {
      while (!finished) {
        const auto snapshot = trainer.Snapshots()->Latest();
        if (!snapshot) continue;
        const RenderedView view = snapshot->Render(FirstView(small));
        const std::lock_guard lock(mutex);
        pictures[snapshot->Step()].push_back(view.rgb.pixels);
      }
    };
    std::vector<std::jthread> viewers;
    for (int i = 0; i < 4; ++i) viewers.emplace_back(view_snapshots);
    EXPECT_TRUE(trainer.Run(test::never_stop).finished);
    finished = true;
  }
  ASSERT_GE(pictures.size(), 2u);
  Trainer again(config, small.scene, small.data, {});
  std::int64_t step = 0;
  for (const auto& [of_step, seen] : pictures) {
    again.TakeSteps(static_cast<int>(of_step - step));
    step = of_step;
    const std::vector<float> expected =
        ModelSnapshot::Copy(again.GetModel(), step)->Render(FirstView(small)).rgb.pixels;
    for (const auto& picture : seen) EXPECT_EQ(picture, expected) << "step " << of_step;
  }
  SetNumThreads(AvailableCores());
}

TEST(SnapshotSlot, HasTheLastStepAfterTheTrainingEnds) {
  const test::SmallCapture small = test::MakeSmallCapture(10, 24, 18);
  const test::ScratchFolder run;
  std::shared_ptr<SnapshotSlot> slot;
  {
    Trainer trainer(EveryModule(20), small.scene, small.data, run.path());
    slot = trainer.Snapshots();
    EXPECT_EQ(slot->Latest(), nullptr);
    trainer.Run(test::never_stop);
  }
  ASSERT_NE(slot->Latest(), nullptr);
  EXPECT_EQ(slot->Latest()->Step(), 20);
}

TEST(SnapshotSlot, CopiesNothingWithoutARequest) {
  const test::SmallCapture small = test::MakeSmallCapture(10, 24, 18);
  const test::ScratchFolder run;
  Trainer trainer(EveryModule(20), small.scene, small.data, run.path());
  trainer.Run(test::never_stop);
  EXPECT_EQ(trainer.Snapshots()->Latest(), nullptr);
}

TEST(ModelSnapshot, DoesNotChangeDuringTraining) {
  const test::SmallCapture small = test::MakeSmallCapture(10, 24, 18);
  Trainer trainer(EveryModule(40), small.scene, small.data, {});
  trainer.TakeSteps(20);
  const auto before = ModelSnapshot::Copy(trainer.GetModel(), 20);
  const std::vector<float> picture = before->Render(FirstView(small)).rgb.pixels;
  const std::vector<float> fast = before->Render(FirstView(small, 0.25)).rgb.pixels;
  EXPECT_NE(picture, fast);
  trainer.TakeSteps(20);
  EXPECT_EQ(before->Render(FirstView(small)).rgb.pixels, picture);
  EXPECT_EQ(before->Render(FirstView(small, 0.25)).rgb.pixels, fast);
  EXPECT_NE(ModelSnapshot::Copy(trainer.GetModel(), 40)->Render(FirstView(small)).rgb.pixels,
            picture);
}

TEST(ModelSnapshot, OfACheckpointEqualsThatOfTheTraining) {
  const test::SmallCapture small = test::MakeSmallCapture(10, 24, 18);
  const test::ScratchFolder run;
  Trainer trainer(EveryModule(20), small.scene, small.data, run.path());
  trainer.Run(test::never_stop);
  const ModelSnapshot opened(ModelFromCheckpoint(ReadRunCheckpoint(run.path())), 20);
  EXPECT_EQ(opened.Render(FirstView(small)).rgb.pixels,
            ModelSnapshot::Copy(trainer.GetModel(), 20)->Render(FirstView(small)).rgb.pixels);
}

TEST(SnapshotSlot, NeedsASnapshotOnlyAfterARequest) {
  SnapshotSlot slot;
  EXPECT_FALSE(slot.IsRequested());
  EXPECT_EQ(slot.Latest(), nullptr);
  EXPECT_TRUE(slot.IsRequested());
  const test::SmallCapture small = test::MakeSmallCapture(10, 24, 18);
  slot.Publish(ModelSnapshot::Copy(MakeModel(EveryModule(1), small.scene), 7));
  EXPECT_FALSE(slot.IsRequested());
  ASSERT_NE(slot.Latest(), nullptr);
  EXPECT_EQ(slot.Latest()->Step(), 7);
}

}  // namespace
}  // namespace nerf
