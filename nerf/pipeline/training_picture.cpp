#include "nerf/pipeline/training_picture.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>

#include "nerf/image/image_io.h"
#include "nerf/model/evaluation.h"
#include "nerf/model/run_folder.h"
#include "nerf/output/contact_sheet.h"

namespace nerf {
namespace {

constexpr int kLongestSide = 640, kShortestSide = 16;  // pixels

}  // namespace

std::optional<std::filesystem::path> WriteTrainingPicture(const SceneModel& model, double quality,
                                                          const PosedImages& posed,
                                                          const std::filesystem::path& run) {
  const auto held_out = std::ranges::find(posed.images, Split::kTest, &PosedImage::split);
  const PosedImage& image = held_out == posed.images.end() ? posed.images.front() : *held_out;
  const Camera& camera = posed.cameras[image.camera];
  const int trained = model.GetConfig().data.downscale;
  const int longest = std::max(camera.width, camera.height);
  const int shortest = std::min(camera.width, camera.height);
  const int downscale = std::max(
      trained, std::min((longest + kLongestSide - 1) / kLongestSide, shortest / kShortestSide));
  if (shortest / downscale < kShortestSide) return std::nullopt;
  std::vector<ContactSheetRow> rows;
  Evaluate(model, posed, {&image},
           {quality, false, downscale},
           [&](const EvaluatedView& view) {
             rows.push_back({fmt::format("{}  {:.2f} dB", image.name, view.score->psnr),
                             *view.truth, *view.rendering});
           });
  if (rows.empty()) return std::nullopt;
  const std::filesystem::path file = PicturePath(run);
  WriteImage(file, ContactSheet(rows));
  return file;
}

}  // namespace nerf
