#include "nerf/study/study.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "nerf/base/atomic_file.h"
#include "nerf/model/run_folder.h"
#include "nerf/synthetic/sample_folder.h"
#include "sfm/transforms_json.h"
#include "tests/support/input_error_of.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/tiny_training.h"

namespace nerf {
namespace {

using testing::HasSubstr;

using test::never_stop;

PosedImages SmallSample(const test::ScratchFolder& folder, int views) {
  synthetic::SampleOptions options;
  options.views = views;
  options.width = 32;
  options.height = 24;
  options.samples_per_pixel = 1;
  synthetic::WriteSample(folder.path() / "sample", options);
  return sfm::ReadTransformsJson(folder.path() / "sample/truth/transforms.json");
}

// With nothing left of the budget every setting still gets its second.
TEST(Study, MeasuresEverySettingAndGoesOnWhereItStopped) {
  const test::ScratchFolder folder;
  const PosedImages posed = SmallSample(folder, 10);
  StudyOptions options;
  options.budget = 1;
  const auto out = folder.path() / "study";
  MakeOutputFolder(out);

  std::atomic<bool> stop = false;
  Study first(posed, options, out);
  std::vector<std::size_t> begun;
  const auto note = [&](std::size_t number, const StudySetting&, double seconds) {
    begun.push_back(number);
    EXPECT_GE(seconds, 1);
    if (number == 2) stop = true;
  };
  EXPECT_FALSE(first.Run(stop, note));
  EXPECT_EQ(begun, (std::vector<std::size_t>{0, 1, 2}));

  Study again(posed, options, out);
  EXPECT_EQ(again.Results()["settings"].size(), 2u);
  EXPECT_TRUE(again.Run(never_stop, note));
  EXPECT_EQ(begun[3], 2u);

  const auto json = nlohmann::json::parse(ReadWholeFile(out / "study.json"));
  ASSERT_EQ(json["settings"].size(), again.Settings());
  int on_front = 0;
  double before = 0;
  for (const auto& setting : json["settings"]) {
    EXPECT_GT(setting["steps"], 0);
    EXPECT_EQ(setting["dial"].size(), 5u);
    for (const auto& position : setting["dial"]) {
      EXPECT_GT(position["psnr"], 3) << setting["name"];
      EXPECT_GT(position["seconds_per_frame"], 0);
    }
    EXPECT_GT(setting["stage_seconds"]["networks"], 0);
    on_front += setting["on_training_front"].get<bool>();
    before = setting["seconds"];
  }
  EXPECT_GT(before, 0);
  EXPECT_GE(on_front, 1);
  // Every setting can be looked at as any run.
  EXPECT_EQ(OpenRun(out / "runs" / "narrow").model.config.field.hidden_width, 32);

  options.budget = 2;
  EXPECT_THAT(test::InputErrorOf([&] { Study(posed, options, out); }), HasSubstr("budget_seconds"));
}

TEST(Study, NeedsPhotographsToMeasureOn) {
  const test::ScratchFolder folder;
  EXPECT_THAT(
      test::InputErrorOf([&] { Study(SmallSample(folder, 5), StudyOptions{}, folder.path()); }),
      HasSubstr("held-out"));
}

}  // namespace
}  // namespace nerf
