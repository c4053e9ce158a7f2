#include "nerf/scene/splits.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "nerf/scene/representative_cameras.h"

namespace nerf {
namespace {

constexpr std::size_t kFewestToHoldOut = 8, kFewestToValidate = 16;
constexpr std::size_t kTrainedForEachValidated = 16, kFewestValidated = 3;

bool Defines(const PosedImages& posed, Split split) {
  return std::ranges::any_of(posed.images,
                             [split](const PosedImage& image) { return image.split == split; });
}

}  // namespace

void AssignSplits(PosedImages& posed, const DataOptions& options) {
  std::vector<PosedImage*> by_name;
  for (PosedImage& image : posed.images) by_name.push_back(&image);
  std::ranges::sort(by_name, {}, [](const PosedImage* image) { return image->name; });

  const bool holds_out =
      !Defines(posed, Split::kTest) && options.test_every > 0 && by_name.size() >= kFewestToHoldOut;
  std::vector<PosedImage*> train;
  for (std::size_t i = 0; i < by_name.size(); ++i) {
    Split& split = by_name[i]->split;
    if (holds_out && i % options.test_every == 0) split = Split::kTest;
    if (split == Split::kUnspecified) split = Split::kTrain;
    if (split == Split::kTrain) train.push_back(by_name[i]);
  }
  if (Defines(posed, Split::kValidation) || train.size() < kFewestToValidate) return;
  const std::size_t count =
      std::min({std::max(train.size() / kTrainedForEachValidated, kFewestValidated),
                static_cast<std::size_t>(options.validation_images), train.size() / 8});
  std::vector<Eigen::Isometry3d> cameras;
  for (const PosedImage* image : train) cameras.push_back(image->world_from_camera);
  for (const std::size_t i : RepresentativeCameras(cameras, count)) {
    train[i]->split = Split::kValidation;
  }
}

}  // namespace nerf
