#include "nerf/pipeline/training_session.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "nerf/base/atomic_file.h"
#include "nerf/model/run_folder.h"
#include "nerf/pipeline/found_points.h"
#include "nerf/synthetic/sample_folder.h"
#include "tests/support/fake_colmap.h"
#include "tests/support/input_error_of.h"
#include "tests/support/photo_files.h"
#include "tests/support/scene_folder.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/tiny_training.h"

namespace nerf {
namespace {

using testing::ElementsAre;

// The names of the first event of each kind, in order; warnings and progress are left out.
class EventNames {
 public:
  void operator()(const PipelineEvent& event) {
    const char* name = std::visit([this](const auto& e) { return NameOf(e); }, event);
    if (name && std::ranges::find(names, std::string(name)) == names.end()) names.push_back(name);
  }

  std::vector<std::string> names;
  std::vector<std::string> undecided;
  std::shared_ptr<SnapshotSlot> snapshots;
  std::int64_t steps = 0;

 private:
  template <class Event>
  const char* NameOf(const Event&) {
    return nullptr;
  }
  const char* NameOf(const CaptureInspected&) { return "inspected"; }
  const char* NameOf(const DataPlanned&) { return "planned"; }
  const char* NameOf(const EffectsUndecided& event) {
    undecided = event.effects;
    return "undecided";
  }
  const char* NameOf(const TrainingBegan& event) {
    snapshots = event.snapshots;
    snapshots->Latest();  // as a viewer does that is connected
    return "began";
  }
  const char* NameOf(const TrainerEvent& event) {
    if (const auto* step = std::get_if<StepTaken>(&event)) steps = step->step;
    return "step";
  }
  const char* NameOf(const TrainingEnded&) { return "ended"; }
};

class TrainingSessionTest : public testing::Test {
 protected:
  TrainingSessionTest() {
    synthetic::SampleOptions options;
    options.views = 9;
    options.width = 32;
    options.height = 24;
    options.samples_per_pixel = 1;
    synthetic::WriteSample(folder_.path() / "sample", options);
    request_.input = folder_.path() / "sample/truth/transforms.json";
    request_.run = folder_.path() / "run";
    request_.assignments = {"train.steps=20", "encoding.log2_table_size=12",
                            "field.hidden_width=16", "train.max_rays_per_batch=256"};
  }

  test::ScratchFolder folder_;
  TrainingRequest request_;
};

TEST_F(TrainingSessionTest, ReportsItsStagesInOrder) {
  EventNames events;
  TrainingSession session(request_, Stopwatch(), [&](const PipelineEvent& e) { events(e); });
  const TrainSummary summary = session.Run(test::never_stop);
  EXPECT_TRUE(summary.finished);
  EXPECT_EQ(events.steps, 20);
  EXPECT_THAT(events.names,
              ElementsAre("inspected", "planned", "undecided", "began", "step", "ended"));
  ASSERT_TRUE(events.snapshots);
  ASSERT_NE(events.snapshots->Latest(), nullptr);
  EXPECT_EQ(events.snapshots->Latest()->Step(), 20);
  EXPECT_EQ(OpenRun(request_.run).model->Step(), 20);
}

TEST_F(TrainingSessionTest, ResumesWhatWasStopped) {
  std::atomic<bool> stop = false;
  TrainingSession session(request_, Stopwatch(), [&](const PipelineEvent& event) {
    const auto* of_trainer = std::get_if<TrainerEvent>(&event);
    const auto* step = of_trainer ? std::get_if<StepTaken>(of_trainer) : nullptr;
    if (step && step->step == 8) stop = true;
  });
  EXPECT_FALSE(session.Run(stop).finished);
  EventNames events;
  const auto resumed = TrainingSession::Resume(request_.run, Stopwatch(),
                                               [&](const PipelineEvent& e) { events(e); });
  EXPECT_TRUE(resumed->Run(test::never_stop).finished);
  EXPECT_EQ(events.steps, 20);
  EXPECT_THAT(events.names, ElementsAre("planned", "began", "step", "ended"));
}

// The user's decisions stand, and a second run does not overwrite the first.
TEST_F(TrainingSessionTest, KeepsWhatTheUserDecided) {
  request_.effects.choices = {{&kRobustEffect, true}, {&kViewDependenceEffect, false}};
  TrainingSession session(request_, Stopwatch(), IgnoreEvents);
  session.Run(test::never_stop);
  const Config& config = session.GetConfig();
  EXPECT_TRUE(config.effects.robust);
  EXPECT_FALSE(config.effects.view_dependence);
  TrainingSession again(request_, Stopwatch(), IgnoreEvents);
  EXPECT_THAT(test::InputErrorOf([&] { again.Run(test::never_stop); }),
              testing::HasSubstr("already contains a run"));
}

// Photographs without poses, for which a program stands in that makes some up.
TEST_F(TrainingSessionTest, ChoosesTheResolutionOfPhotographs) {
  const test::FakeColmap colmap;
  const test::ScratchFolder photos;
  for (int i = 0; i < 6; ++i) {
    test::WritePhoto(photos.path() / fmt::format("p{}.png", i), 1300, 40);
  }
  colmap.Set("size", "1300 40");
  colmap.Set("models", "0 6\n");
  request_.input = photos.path();
  std::optional<ResolutionChosen> chosen;
  std::optional<WaitEstimated> wait;
  const PipelineListener listener = [&](const PipelineEvent& event) {
    if (const auto* e = std::get_if<ResolutionChosen>(&event)) chosen = *e;
    if (const auto* e = std::get_if<WaitEstimated>(&event)) wait = *e;
  };
  TrainingSession session(request_, Stopwatch(), listener);
  session.Run(test::never_stop);
  ASSERT_TRUE(wait);
  EXPECT_EQ(wait->photographs, 6);
  ASSERT_TRUE(chosen);
  EXPECT_EQ(chosen->width, 1300);
  EXPECT_EQ(chosen->downscale, 2);
  EXPECT_EQ(session.GetConfig().data.downscale, 2);
  EXPECT_EQ(OpenRun(request_.run).model->GetModel().config.data.downscale, 2);
  EXPECT_TRUE(std::filesystem::exists(PicturePath(request_.run)));
  // What the user says stands, also where it is all pixels.
  chosen.reset();
  request_.run = folder_.path() / "another";
  request_.assignments.push_back("data.downscale=1");
  TrainingSession whole(request_, Stopwatch(), listener);
  whole.Run(test::never_stop);
  EXPECT_FALSE(chosen);
  EXPECT_EQ(whole.GetConfig().data.downscale, 1);
}

TEST_F(TrainingSessionTest, EstimatesTheWaitOfAFilmBeforeItIsRead) {
  const test::FakeColmap colmap;
  colmap.Set("size", "96 64");
  colmap.Set("models", "0 6\n");
  request_.input = folder_.path() / "clip.mp4";
  request_.assignments.push_back("data.film_frames=6");
  ASSERT_EQ(std::system(("ffmpeg -nostdin -v error -f lavfi -i "
                         "testsrc2=size=96x64:rate=25:duration=2 -c:v mpeg4 '" +
                         request_.input.string() + "'")
                            .c_str()),
            0);
  std::vector<std::string> order;
  const PipelineListener listener = [&](const PipelineEvent& event) {
    if (const auto* wait = std::get_if<WaitEstimated>(&event)) {
      order.emplace_back("wait");
      EXPECT_EQ(wait->photographs, 6);
      EXPECT_GT(wait->film_seconds, 0);
      EXPECT_GT(wait->pose_seconds, 0);
    }
    if (std::holds_alternative<FilmRead>(event)) order.emplace_back("film");
    if (std::holds_alternative<PosesFound>(event)) order.emplace_back("poses");
  };
  TrainingSession(request_, Stopwatch(), listener).Run(test::never_stop);
  EXPECT_THAT(order, testing::ElementsAre("wait", "film", "poses"));
}

// Poses without points, of photographs in which the fake COLMAP finds features.
TEST_F(TrainingSessionTest, FindsPointsForGivenPosesWhereThereIsTime) {
  const test::FakeColmap colmap;
  test::FeatureScene scene({.images = 8, .points = 200});
  colmap.SetFeatures(test::WritePhotographsOf(scene, folder_.path()));
  int points = 0;
  const PipelineListener listener = [&](const PipelineEvent& event) {
    if (const auto* e = std::get_if<PointsFound>(&event)) points = e->report.points;
  };
  const std::filesystem::path run = folder_.path() / "points";
  PosedImages posed = scene.posed;
  FindMissingPoints(posed, run, 0.001, listener);  // no time
  EXPECT_TRUE(posed.points.empty());
  EXPECT_FALSE(std::filesystem::exists(run));
  FindMissingPoints(posed, run, 1000, listener);
  EXPECT_GT(points, 150);
  EXPECT_EQ(posed.points.size(), static_cast<std::size_t>(points));
  colmap.ForgetCalls();
  FindMissingPoints(posed, run, 1000, listener);  // it has points now
  EXPECT_TRUE(colmap.Calls().empty());
}

TEST_F(TrainingSessionTest, KeepsTheSizeOfCapturesWithPoses) {
  request_.assignments.push_back("train.time_budget=0");
  bool chosen = false;
  TrainingSession session(request_, Stopwatch(), [&](const PipelineEvent& event) {
    chosen = chosen || std::holds_alternative<ResolutionChosen>(event);
  });
  session.Run(test::never_stop);
  EXPECT_FALSE(chosen);
}

}  // namespace
}  // namespace nerf
