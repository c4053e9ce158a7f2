#include "nerf/scene/splits.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace nerf {
namespace {

constexpr std::size_t kFewestToHoldOut = 8, kFewestToValidate = 16;

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
  // Evenly over the capture, away from its ends.
  const std::size_t count = std::min<std::size_t>(options.validation_images, train.size() / 8);
  for (std::size_t k = 0; k < count; ++k) {
    train[(2 * k + 1) * train.size() / (2 * count)]->split = Split::kValidation;
  }
}

}  // namespace nerf
