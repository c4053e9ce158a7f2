#include "nerf/config/config.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <set>

#include "nerf/base/atomic_file.h"
#include "nerf/base/input_error.h"
#include "tests/support/scratch_folder.h"

namespace nerf {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

std::string ErrorOf(const std::string& preset, const std::vector<std::string>& assignments) {
  try {
    LoadConfig(preset, assignments);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Config, EveryPresetLoads) {
  EXPECT_GE(BuiltInPresets().size(), 4u);
  for (const auto& [name, text] : BuiltInPresets()) EXPECT_NO_THROW(LoadConfig(name, {})) << name;
}

TEST(Config, TheBasePresetContainsEveryKeyWithItsDefault) {
  EXPECT_EQ(nlohmann::json::parse(BuiltInPresets().at("base")), JsonFromConfig(Config()));
}

TEST(Config, AssignmentsChangeSingleKeys) {
  const Config config =
      LoadConfig("base", {"train.steps=77", "loss.kind=mse", "march.far_distance=50"});
  EXPECT_EQ(config.train.steps, 77);
  EXPECT_EQ(config.loss.kind, LossKind::kMse);
  EXPECT_EQ(config.march.far_distance, 50.0);
}

TEST(Config, AnUnknownKeyIsNamed) {
  EXPECT_THAT(ErrorOf("base", {"train.stps=5"}),
              AllOf(HasSubstr("train.stps"), HasSubstr("steps")));
  EXPECT_THAT(ErrorOf("base", {"nonsense=5"}), HasSubstr("nonsense"));
}

TEST(Config, AWrongTypeIsNamed) {
  EXPECT_THAT(ErrorOf("base", {"train.steps=many"}),
              HasSubstr("train.steps must be a whole number"));
  EXPECT_THAT(ErrorOf("base", {"train.steps=1.5"}),
              HasSubstr("train.steps must be a whole number"));
  EXPECT_THAT(ErrorOf("base", {"loss.kind=3"}), HasSubstr("loss.kind must be string"));
  EXPECT_THAT(ErrorOf("base", {"train=3"}), HasSubstr("train must be an object"));
}

TEST(Config, AValueOutOfRangeIsNamed) {
  EXPECT_THAT(ErrorOf("base", {"train.steps=0"}), HasSubstr("train.steps"));
  EXPECT_THAT(ErrorOf("base", {"encoding.features=3"}), HasSubstr("encoding.features"));
  EXPECT_THAT(ErrorOf("base", {"encoding.levels=4294967297"}), HasSubstr("encoding.levels"));
  EXPECT_THAT(ErrorOf("base", {"train.seed=-1"}),
              HasSubstr("train.seed must be a whole number, 0 or more"));
  EXPECT_THAT(ErrorOf("base", {"loss.kind=l7"}), HasSubstr("l7"));
  EXPECT_THAT(ErrorOf("base", {"march.far_distance=2e8"}), HasSubstr("march.far_distance"));
  EXPECT_THAT(ErrorOf("base", {"train.error_driven_share=1.5"}),
              HasSubstr("train.error_driven_share"));
  for (const char* budget : {"0.5", "-1", "1e9"}) {
    EXPECT_THAT(ErrorOf("base", {std::string("train.time_budget=") + budget}),
                HasSubstr("train.time_budget"));
  }
  EXPECT_THAT(ErrorOf("base", {"train.target_psnr=-1"}), HasSubstr("train.target_psnr"));
}

TEST(Config, AValueThatIsNotValidUtf8IsRejected) {
  EXPECT_THAT(ErrorOf("base", {"train.steps=\xe9\x01"}), HasSubstr("train.steps"));
}

TEST(Config, AnEffectIsOnWhereItsBlockIsPresent) {
  EXPECT_FALSE(LoadConfig("base", {}).effects.exposure);
  EXPECT_TRUE(LoadConfig("base", {"effects.exposure={}"}).effects.exposure);
  EXPECT_FALSE(
      LoadConfig("base", {"effects.exposure={}", "effects.exposure=null"}).effects.exposure);
  // A run folder's config.json restores the effect, on or off.
  for (const char* effect : {"effects.exposure={}", "effects.exposure=null"}) {
    const Config config = LoadConfig("base", {effect});
    EXPECT_EQ(JsonFromConfig(ConfigFromJson(JsonFromConfig(config), "test")),
              JsonFromConfig(config));
  }
}

TEST(Config, AnUnknownEffectIsReportedWithTheKnownOnes) {
  EXPECT_THAT(ErrorOf("base", {"effects.exposr={}"}),
              AllOf(HasSubstr("effects.exposr"), HasSubstr("exposure")));
  EXPECT_THAT(ErrorOf("base", {"effects.exposure=true"}),
              HasSubstr("effects.exposure must be an object"));
  EXPECT_THAT(ErrorOf("base", {"effects.exposure={\"stops\": 2}"}),
              HasSubstr("effects.exposure.stops"));
  // Only effects may be null.
  EXPECT_THAT(ErrorOf("base", {"march=null"}), HasSubstr("march must be an object"));
}

TEST(Config, AnAssignmentWithoutAValueIsExplained) {
  EXPECT_THAT(ErrorOf("base", {"train.steps"}), HasSubstr("block.key=value"));
}

TEST(Config, AnUnknownPresetIsReportedWithTheKnownOnes) {
  EXPECT_THAT(ErrorOf("fsat", {}), AllOf(HasSubstr("fsat"), HasSubstr("balanced")));
}

TEST(Config, FilesBuildOnTheirParents) {
  const test::ScratchFolder scratch;
  const auto path = scratch.path() / "config.json";
  std::ofstream(path) << R"({"parent": "quickstart", "train": {"steps": 12}})";
  const Config config = LoadConfig(path.string(), {});
  EXPECT_EQ(config.train.steps, 12);
  EXPECT_EQ(config.encoding.log2_table_size, LoadConfig("quickstart", {}).encoding.log2_table_size);
  std::ofstream(path) << R"({"parent": ")" << path.string() << R"("})";
  EXPECT_THAT(ErrorOf(path.string(), {}), HasSubstr("own parent"));
  std::ofstream(path) << R"({"train": )";
  EXPECT_THAT(ErrorOf(path.string(), {}), HasSubstr("not valid JSON"));
  std::ofstream(path) << R"({"march": {"far_distance": 1e999}})";
  EXPECT_THAT(ErrorOf(path.string(), {}), HasSubstr("out of range"));
}

TEST(Config, EveryKeyHasHelp) {
  std::set<std::string> described;
  for (const OptionHelp& option : ConfigHelp()) {
    EXPECT_GT(option.help.size(), 5u) << option.key;
    EXPECT_FALSE(option.range.empty()) << option.key;
    EXPECT_TRUE(described.insert(option.key).second) << option.key << " is described twice";
  }
  // Exactly the keys of the JSON with every effect on.
  Config config;
  for (const EffectDescriptor* effect : AllEffects()) config = WithEffect(config, *effect, true);
  config.materials.emplace();
  std::set<std::string> keys;
  const nlohmann::json flat = JsonFromConfig(config).flatten();
  for (const auto& [pointer, value] : flat.items()) {
    std::string key = pointer.substr(1);
    std::ranges::replace(key, '/', '.');
    keys.insert(key);
  }
  keys.insert("materials");
  for (const EffectDescriptor* effect : AllEffects()) {
    keys.insert(std::string("effects.") + effect->name);
  }
  EXPECT_EQ(described, keys);
}

TEST(Config, TheDocumentationContainsTheHelpTable) {
  EXPECT_THAT(ReadWholeFile(NERF_DOCUMENTATION "/configuration.md"), HasSubstr(ConfigHelpTable()));
}

TEST(Config, OldEffectNamesAreAccepted) {
  const Config config = LoadConfig(
      "base", {"effects.view=null", "effects.poses={\"rate\": 0.5}", "effects.footprint={}"});
  EXPECT_FALSE(config.effects.view_dependence);
  ASSERT_TRUE(config.effects.pose_refinement);
  EXPECT_EQ(config.effects.pose_refinement->rate, 0.5);
  EXPECT_TRUE(config.effects.anti_aliasing);
  EXPECT_EQ(NamedEffects("base", {"effects.depth={}"}),
            (std::set<std::string>{"depth_supervision"}));
  // As in a checkpoint of the previous version.
  const Config old =
      ConfigFromJson({{"effects", {{"view", nullptr}, {"depth", {{"share", 0.2}}}}}}, "test");
  EXPECT_FALSE(old.effects.view_dependence);
  EXPECT_EQ(old.effects.depth_supervision->share, 0.2);
}

TEST(Config, AnUnknownEnumeratorIsReportedWithTheKnownOnes) {
  EXPECT_THAT(
      ErrorOf("base", {"march.sampler=grid"}),
      AllOf(HasSubstr("march.sampler"), HasSubstr("grid"), HasSubstr("auto, occupancy, proposal")));
  EXPECT_THAT(ErrorOf("base", {"train.engine=gpu"}), HasSubstr("fused, libtorch"));
}

TEST(Config, EveryNumberIsCheckedAgainstItsRange) {
  EXPECT_THAT(ErrorOf("base", {"optimizer.beta1=1"}),
              HasSubstr("optimizer.beta1 is 1; use 0 to 0.9999"));
  EXPECT_THAT(ErrorOf("base", {"proposal.encoding.levels=0"}),
              HasSubstr("proposal.encoding.levels"));
  EXPECT_THAT(ErrorOf("base", {"effects.robust={\"scale\": 0}"}),
              HasSubstr("effects.robust.scale"));
  EXPECT_THAT(ErrorOf("base", {"data.test_every=1"}), HasSubstr("0 or 2 or more"));
  EXPECT_THAT(ErrorOf("base", {"encoding.base_resolution=4096"}), HasSubstr("max_resolution"));
  EXPECT_THAT(ErrorOf("base", {"march.near_distance=200"}), HasSubstr("near < far"));
}

TEST(Config, SurvivesARoundTripThroughJson) {
  const Config config = LoadConfig("accurate", {"train.seed=18446744073709551615"});
  EXPECT_EQ(JsonFromConfig(ConfigFromJson(JsonFromConfig(config), "test")), JsonFromConfig(config));
}

}  // namespace
}  // namespace nerf
