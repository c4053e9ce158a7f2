#include "nerf/model/evaluation.h"

#include <gtest/gtest.h>

#include "nerf/pipeline/prepared_scene.h"
#include "nerf/synthetic/sample_folder.h"
#include "nerf/train/validation.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/tiny_training.h"

namespace nerf {
namespace {

// Trainings and trials measure a sample of pixels with Validation, because whole views would take
// longer than the steps between two measurements. Both must measure the same.
TEST(Evaluation, OfWholeViewsAgreesWithTheSampleOfPixelsThatTrialsMeasure) {
  const test::ScratchFolder folder;
  synthetic::SampleOptions options;
  options.scenario = synthetic::Scenario::kExposure;
  options.views = 17;
  options.width = 32;
  options.height = 24;
  options.samples_per_pixel = 1;
  synthetic::WriteSample(folder.path() / "sample", options);
  const Config config = test::TinyConfig(150);
  PreparedScene scene = PrepareScene(folder.path() / "sample/truth/transforms.json", folder.path(),
                                     config.data, IgnoreEvents);
  for (PosedImage& image : scene.posed.images) {
    if (image.split == Split::kTest) image.split = Split::kValidation;
  }
  const Dataset data = LoadPhotographs(scene.posed, config, scene.normalized_from_world,
                                       folder.path(), IgnoreEvents);
  const SceneFacts facts = FactsOf(data, scene.normalized_from_world);
  const Model model = test::Trained(config, facts, data);
  const Validation validation(data.validation, 1);
  const auto snapshot = ModelSnapshot::Copy(model, 150);

  const auto whole = [&](bool fit_exposure) {
    return Evaluate(*snapshot, scene.posed, ImagesOf(scene.posed, Split::kValidation),
                    {1, fit_exposure, {}})
        .Mean()
        .psnr;
  };
  for (const bool fit_exposure : {false, true}) {
    EXPECT_NEAR(validation.Psnr(model, fit_exposure), whole(fit_exposure), 0.3);
  }
  EXPECT_GT(whole(true), whole(false) + 1);  // the exposures differ
}

}  // namespace
}  // namespace nerf
