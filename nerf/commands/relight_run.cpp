#include "nerf/commands/relight_run.h"

#include <spdlog/fmt/fmt.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "nerf/base/atomic_file.h"
#include "nerf/base/interrupt.h"
#include "nerf/base/progress.h"
#include "nerf/base/stopwatch.h"
#include "nerf/capture/relight.h"
#include "nerf/image/image_io.h"
#include "nerf/model/materials_file.h"
#include "nerf/model/run_folder.h"
#include "nerf/output/video.h"
#include "nerf/relight/environment_light.h"
#include "nerf/relight/relit_view.h"

namespace nerf {
namespace {

namespace fs = std::filesystem;

// The directions of the normalized frame in the map, which is turned about the vertical axis,
// counter-clockwise as seen from above.
Eigen::Matrix3d TurnedMap(const SceneNormalization& frame, double degrees) {
  const double angle = -degrees * std::numbers::pi / 180;
  return Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitY()).toRotationMatrix() *
         MapFromFrame(frame.rotation);
}

// Linear, 4 channels: straight colour and opacity. What is not part of the surface stays as the
// field shows it.
Image RelitImage(const Relighter& relighter, const RenderedView& rendered, const DepthMap& depth,
                 ColorEncoding encoding, bool has_alpha) {
  Image image(depth.camera.width, depth.camera.height, 4, ColorEncoding::kLinear);
  for (std::size_t p = 0; p < depth.opacity.pixels.size() && !has_alpha; ++p) {
    for (int c = 0; c < 3; ++c) {
      const float shown = rendered.rgb.pixels[3 * p + c];
      image.pixels[4 * p + c] = encoding == ColorEncoding::kLinear ? shown : LinearFromSrgb(shown);
    }
    image.pixels[4 * p + 3] = 1;
  }
  const SeenSurface seen = relighter.See(depth);
  const RelitPixels relit = relighter.Reflect(seen);
  const torch::Tensor sum = (relit.direct + relit.indirect).contiguous();
  for (std::size_t i = 0; i < seen.pixels.size(); ++i) {
    const auto p = static_cast<std::size_t>(seen.pixels[i]);
    for (int c = 0; c < 3; ++c) image.pixels[4 * p + c] = sum.data_ptr<float>()[3 * i + c];
    image.pixels[4 * p + 3] = has_alpha ? depth.opacity.pixels[p] : 1;
  }
  return image;
}

// As nerf render shows it: before the display background, in sRGB.
Image Displayed(const Image& linear, double stops, bool has_alpha) {
  const Image exposed = WithExposure(linear, stops);
  const Eigen::Vector3f background = DisplayBackground(has_alpha);
  Image shown(linear.width, linear.height, 3);
  for (std::size_t p = 0; p < shown.pixels.size() / 3; ++p) {
    const float opacity = linear.pixels[4 * p + 3];
    for (int c = 0; c < 3; ++c) {
      const float value = std::clamp(exposed.pixels[4 * p + c], 0.0f, 1.0f);
      shown.pixels[3 * p + c] = opacity * SrgbFromLinear(value) + (1 - opacity) * background[c];
    }
  }
  return shown;
}

// Of the opaque pixels.
double ExposureOf(const Image& linear) {
  Image opaque(1, 0, 3, ColorEncoding::kLinear);
  for (std::size_t p = 0; p < linear.pixels.size() / 4; ++p) {
    if (linear.pixels[4 * p + 3] < 0.5f) continue;
    for (int c = 0; c < 3; ++c) opaque.pixels.push_back(linear.pixels[4 * p + c]);
    ++opaque.height;
  }
  return opaque.height > 0 ? AutoExposure(opaque) : 0;
}

fs::path OutputOf(const RelightRunArguments& arguments) {
  if (!arguments.output.empty()) return arguments.output;
  return fs::path(arguments.run) / "relit" / fs::path(arguments.environment).stem();
}

}  // namespace

bool IsRun(const std::string& path) { return fs::exists(CheckpointPath(path)); }

void RelightRun(const RelightRunArguments& arguments, const EnvironmentMap& map) {
  const Stopwatch watch;
  const OpenedRun run = OpenRun(arguments.run);
  const Materials materials = ReadMaterials(MaterialsPath(arguments.run));
  const SceneFacts& scene = run.model->Scene();
  const ShotList list = ChooseShots(run, arguments.shots, arguments.run);
  const fs::path folder = OutputOf(arguments);
  MakeOutputFolder(folder);
  Relighter relighter(materials.surface);
  relighter.SetLight(RadianceFrom(map, relighter.Directions(),
                                  TurnedMap(scene.normalized_from_world, arguments.rotate)),
                     arguments.bounces);
  const double prepared = watch.Seconds();
  std::optional<double> stops = arguments.exposure;
  ProgressLine progress("relighting", static_cast<std::int64_t>(list.shots.size()));
  std::int64_t done = 0;
  const auto& stop = StopOnInterrupt();
  for (const Shot& shot : list.shots) {
    if (stop) {
      progress.Finish();
      fmt::print("stopped; the finished pictures are in {}\n", folder.string());
      throw CLI::RuntimeError(130);
    }
    const RenderedView rendered = run.model->Render({shot.camera, shot.world_from_camera});
    const DepthMap depth{shot.camera,
                         scene.normalized_from_world.NormalizedFromCamera(shot.world_from_camera),
                         rendered.depth, rendered.opacity};
    const Image relit = RelitImage(relighter, rendered, depth, scene.encoding, scene.has_alpha);
    if (!stops) stops = ExposureOf(relit);  // one for all views
    WriteImage(folder / (shot.name + ".exr"), relit);
    WriteImage(folder / (shot.name + ".png"), Displayed(relit, *stops, scene.has_alpha));
    progress.Update(++done, shot.name);
  }
  progress.Finish();
  if (list.frames_per_second && !FfmpegIsInstalled()) {
    fmt::print("no film.mp4, which needs the program ffmpeg\n");
  } else if (list.frames_per_second) {
    WriteVideo(folder, static_cast<int>(list.shots.size()), *list.frames_per_second,
               folder / "film.mp4");
  }
  fmt::print(
      "{} view{} at {:+.2f} stops; {:.1f} s for shadows and bounces, {:.2f} s a view\n"
      "PNG and linear EXR are in {}\n",
      done, done == 1 ? "" : "s", stops.value_or(0), prepared,
      (watch.Seconds() - prepared) / static_cast<double>(done), folder.string());
}

}  // namespace nerf
