#include "nerf/model/gaussian_model.h"

#include <algorithm>
#include <exception>
#include <utility>

#include "nerf/base/input_error.h"
#include "nerf/base/parallel.h"
#include "nerf/base/stopwatch.h"
#include "nerf/scene/dataset.h"
#include "nerf/splats/gaussian_camera.h"
#include "nerf/splats/gaussian_renderer.h"

namespace nerf {
namespace {

constexpr float kLeastOpacity = 1e-3f;  // below it depth is undefined
constexpr std::int64_t kRowsAtOnce = 16;
// Tensors of the file.
constexpr char kGaussians[] = "gaussians", kFirstMoment[] = "first_moment",
               kSecondMoment[] = "second_moment", kNeed[] = "need";
// Of its JSON.
constexpr char kPlannedSeconds[] = "planned_seconds", kPlannedSteps[] = "planned_steps",
               kSecondsPerFrame[] = "seconds_per_frame";

GaussianModel ModelOf(const Checkpoint& checkpoint, const std::filesystem::path& file) {
  try {
    const nlohmann::json& meta = checkpoint.meta;
    const auto order = meta.at("harmonics_order").get<int>();
    const auto count = meta.at("gaussians").get<std::int64_t>();
    const auto stored = checkpoint.tensors.find(kGaussians);
    // Before anything is allocated.
    if (order < 0 || order > kernels::kMostHarmonicsOrder || count < 1 ||
        stored == checkpoint.tensors.end() || stored->second.dim() != 3 ||
        stored->second.scalar_type() != torch::kFloat ||
        !torch::isfinite(stored->second).all().item<bool>() ||
        !(meta.at("near").get<double>() > 0 && meta.at("near").get<double>() < 1e6) ||
        stored->second.numel() / kernels::GaussianRows(order) < count ||
        stored->second.numel() / kernels::GaussianRows(order) >=
            count + kernels::kGaussiansInBlock) {
      throw InputError(
          "{}: the Gaussians are damaged, or not as many as it says; make them "
          "again with nerf splat",
          file.string());
    }
    GaussianCloud cloud(count, order);
    CopyTensor(checkpoint.tensors, kGaussians, cloud.parameters);
    const FitFacts made = {meta.at("step"), meta.value("fit_seconds", 0.0),
                           meta.value("field_step", std::int64_t{-1})};
    return {ConfigFromJson(meta.at("config"), file.string()), SceneFromJson(meta.at("scene")),
            std::move(cloud), meta.at("near").get<double>(), made};
  } catch (const nlohmann::json::exception& error) {
    throw InputError("{}: is no file of Gaussians ({}); make them again with nerf splat",
                     file.string(), error.what());
  }
}

// A picture on the display background.
RenderedView ViewOf(const GaussianPicture& picture, const SceneFacts& scene) {
  const Eigen::Vector3f background = DisplayBackground(scene.has_alpha);
  RenderedView view;
  view.rgb = Image(picture.width, picture.height, 3, scene.encoding);
  view.opacity = Image(picture.width, picture.height, 1, ColorEncoding::kLinear);
  view.depth = Image(picture.width, picture.height, 1, ColorEncoding::kLinear);
  ParallelFor(picture.height, kRowsAtOnce, [&](std::int64_t first, std::int64_t last) {
    for (auto y = static_cast<int>(first); y < last; ++y) {
      const float* const T = picture.Row(GaussianPicture::kTransmittance, y);
      const float* const distance = picture.Row(GaussianPicture::kDistance, y);
      for (int x = 0; x < picture.width; ++x) {
        for (int c = 0; c < 3; ++c) {
          view.rgb.At(x, y)[c] = picture.Row(c, y)[x] + T[x] * background[c];
        }
        const float opacity = 1 - T[x];
        *view.opacity.At(x, y) = opacity;
        *view.depth.At(x, y) = opacity > kLeastOpacity ? distance[x] / opacity : 0;
      }
    }
  });
  return view;
}

// Where the lens covers nothing there is the background, as in pictures of the field.
void EmptyOutsideLens(const std::vector<std::uint32_t>& covered, const SceneFacts& scene,
                      RenderedView& view) {
  const Eigen::Vector3f background = DisplayBackground(scene.has_alpha);
  auto next = covered.begin();
  for (std::size_t pixel = 0; pixel < view.opacity.pixels.size(); ++pixel) {
    if (next != covered.end() && *next == pixel) {
      ++next;
      continue;
    }
    std::copy_n(background.data(), 3, &view.rgb.pixels[3 * pixel]);
    view.opacity.pixels[pixel] = view.depth.pixels[pixel] = 0;
    if (view.median_depth.pixels.empty()) continue;
    view.median_depth.pixels[pixel] = 0;
    std::fill_n(&view.normal.pixels[3 * pixel], 3, 0.0f);
  }
}

void AddSurface(const GaussianSurface& surface, RenderedView& view) {
  const int width = view.rgb.width, height = view.rgb.height;
  view.median_depth = Image(width, height, 1, ColorEncoding::kLinear);
  view.normal = Image(width, height, 3, ColorEncoding::kLinear);
  view.median_depth.pixels = surface.median_distance;
  for (std::size_t p = 0; p < surface.normal.size(); ++p) {
    std::ranges::copy(surface.normal[p], view.normal.pixels.begin() + 3 * static_cast<long>(p));
  }
}

}  // namespace

GaussianModel::GaussianModel(Config config, SceneFacts scene, GaussianCloud cloud, double near,
                             const FitFacts& made)
    : config_(std::move(config)),
      scene_(std::move(scene)),
      cloud_(std::move(cloud)),
      near_(near),
      made_(made) {}

RenderedView GaussianModel::Render(const ViewRequest& view) const {
  if (view.quality != 1) {
    throw InputError("quality {}: Gaussians are always drawn exactly; use 1, or --with field",
                     view.quality);
  }
  const Eigen::Isometry3d pose =
      scene_.normalized_from_world.NormalizedFromCamera(view.world_from_camera);
  const kernels::GaussianCamera camera = MakeGaussianCamera(view.camera, pose, near_);
  std::unique_ptr<GaussianRenderer> renderer = renderers_->Take();
  RenderedView rendered = ViewOf(renderer->Draw(camera, cloud_.Parameters()), scene_);
  if (view.surface) AddSurface(renderer->FindSurface(camera, cloud_.Parameters()), rendered);
  if (const auto covered = lens_->Of(view.camera); *covered) {
    EmptyOutsideLens(**covered, scene_, rendered);
  }
  rendered.samples = renderer->Visible();
  renderers_->Give(std::move(renderer));
  if (view.progress) {
    view.progress(static_cast<std::int64_t>(view.camera.width) * view.camera.height);
  }
  return rendered;
}

void WriteGaussians(const GaussianModel& model, const std::filesystem::path& file,
                    const InterruptedFit* fit) {
  Checkpoint checkpoint;
  checkpoint.meta = {{"config", JsonFromConfig(model.GetConfig())},
                     {"scene", JsonFromScene(model.Scene())},
                     {"step", model.Made().steps},
                     {"fit_seconds", model.Made().seconds},
                     {"field_step", model.Made().field_step},
                     {"gaussians", model.Cloud().count},
                     {"harmonics_order", model.Cloud().order},
                     {"near", model.Near()}};
  checkpoint.tensors[kGaussians] = model.Cloud().parameters;
  if (fit != nullptr) {
    checkpoint.meta[kPlannedSeconds] = fit->planned_seconds;
    checkpoint.meta[kPlannedSteps] = fit->planned_steps;
    checkpoint.meta[kSecondsPerFrame] = fit->seconds_per_frame;
    checkpoint.tensors[kFirstMoment] = fit->state.first_moment;
    checkpoint.tensors[kSecondMoment] = fit->state.second_moment;
    checkpoint.tensors[kNeed] = fit->state.need;
  }
  WriteCheckpoint(file, checkpoint);
}

GaussianModel ReadGaussians(const std::filesystem::path& file) {
  return ModelOf(ReadCheckpoint(file), file);
}

std::optional<InterruptedFit> ReadInterruptedFit(const std::filesystem::path& file) {
  const Checkpoint checkpoint = ReadCheckpoint(file);
  const GaussianModel model = ModelOf(checkpoint, file);
  const nlohmann::json& meta = checkpoint.meta;
  if (!meta.contains(kPlannedSeconds) && !meta.contains(kPlannedSteps)) return std::nullopt;
  const GaussianCloud& cloud = model.Cloud();
  InterruptedFit fit = {
      {cloud, torch::zeros_like(cloud.parameters), torch::zeros_like(cloud.parameters),
       torch::zeros({cloud.parameters.size(0) * kernels::kGaussiansInBlock}), model.Step()}};
  try {
    fit.planned_seconds = meta.at(kPlannedSeconds);
    fit.planned_steps = meta.at(kPlannedSteps);
    fit.seconds_per_frame = meta.value(kSecondsPerFrame, 0.0);
    CopyTensor(checkpoint.tensors, kFirstMoment, fit.state.first_moment);
    CopyTensor(checkpoint.tensors, kSecondMoment, fit.state.second_moment);
    CopyTensor(checkpoint.tensors, kNeed, fit.state.need);
  } catch (const std::exception& error) {  // of JSON, or InputError without the file's name
    throw InputError("{}: the fit cannot be resumed ({}); make the Gaussians again with nerf splat",
                     file.string(), error.what());
  }
  if (!(fit.planned_seconds >= 0 && fit.seconds_per_frame >= 0 && model.Made().seconds >= 0) ||
      model.Step() < 0 || (fit.planned_seconds == 0 && fit.planned_steps < 1)) {
    throw InputError("{}: the plan of its fit is out of range; make the Gaussians again",
                     file.string());
  }
  return fit;
}

}  // namespace nerf
