#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "nerf/base/atomic_file.h"
#include "nerf/base/input_error.h"
#include "nerf/base/progress.h"
#include "nerf/commands/channel_run.h"
#include "nerf/commands/commands.h"
#include "nerf/commands/model_choice.h"
#include "nerf/commands/ply_scene.h"
#include "nerf/commands/shots.h"
#include "nerf/commands/threads.h"
#include "nerf/commands/view_files.h"
#include "nerf/effects/exposure_fit.h"
#include "nerf/geometry/rays.h"
#include "nerf/image/image_io.h"
#include "nerf/model/quality_probe.h"
#include "nerf/model/run_folder.h"
#include "nerf/output/video.h"
#include "nerf/render/image_renderer.h"
#include "nerf/scene/dataset.h"

namespace nerf {
namespace {

namespace fs = std::filesystem;

struct RenderArguments {
  std::string run;
  std::string output;
  ShotOptions shots;
  std::string with = "auto";
  std::optional<double> fps;
  ViewFiles files;
  ChannelOptions channels;
  bool no_video = false;
  bool preview = false;
  double quality = 1;
  std::optional<double> seconds_per_frame;
  std::string exposure_of;
  int threads = 0;
};

// Applies the exposure of a photograph to a view, except to its background contribution.
void Expose(const std::array<float, 3>& gains, const Eigen::Vector3f& background,
            RenderedView& view) {
  ApplyGains(gains, BackgroundContribution(view.opacity.pixels, {background.data(), 3}),
             view.rgb.pixels);
}

// Whether a run has Gaussians that are better than its field where a frame may take so long.
bool SplatsAreBetterThan(const MeasuredQuality& field, double seconds, const fs::path& run) {
  const std::optional<ComparedPsnr> reached = ReadRepresentation(run).reached;
  if (!reached || !fs::exists(GaussiansPath(run))) return false;
  if (field.seconds > seconds) return true;
  // Errors of the exact picture and of what is left out of it, as if they were independent.
  const double error = std::pow(10, -reached->field / 10) + std::pow(10, -field.psnr / 10);
  return reached->splats > -10 * std::log10(error);
}

// The requested quality, or the highest whose frames take at most the requested time. Prints its
// cost and error, measured on the first view.
double ChooseQuality(const OpenedRun& run, const Shot& shot, const RenderArguments& arguments,
                     bool& uses_splats) {
  if (uses_splats || (!arguments.seconds_per_frame && arguments.quality == 1)) return 1;
  const QualityProbe probe(*run.model, {shot.camera, shot.world_from_camera});
  const MeasuredQuality measured = arguments.seconds_per_frame
                                       ? probe.Choose(*arguments.seconds_per_frame)
                                       : probe.Measure(arguments.quality);
  if (arguments.seconds_per_frame && arguments.with == "auto" &&
      SplatsAreBetterThan(measured, *arguments.seconds_per_frame, arguments.run)) {
    uses_splats = true;
    const std::string seconds = FormatSeconds(*arguments.seconds_per_frame);
    if (measured.seconds > *arguments.seconds_per_frame) {
      fmt::print("no quality of the field takes at most {} a frame; Gaussians are drawn\n",
                 seconds);
    } else {
      fmt::print("at {} a frame the Gaussians are better than the field at quality {:.2f}\n",
                 seconds, measured.quality);
    }
    return 1;
  }
  const std::string loss = std::isinf(measured.psnr)
                               ? "the exact picture"
                               : fmt::format("{:.1f} dB from the exact picture", measured.psnr);
  fmt::print("quality {:.2f}: about {} a frame, {}\n", measured.quality,
             FormatSeconds(measured.seconds), loss);
  std::fflush(stdout);
  if (measured.seconds > arguments.seconds_per_frame.value_or(measured.seconds)) {
    spdlog::warn("no quality takes at most {} a frame; use --downscale for smaller images",
                 FormatSeconds(*arguments.seconds_per_frame));
  }
  return measured.quality;
}

void CheckArguments(const RenderArguments& arguments) {
  if (arguments.with == "splats" &&
      (arguments.preview || arguments.seconds_per_frame || arguments.quality != 1)) {
    throw InputError(
        "--with splats: Gaussians are always drawn exactly, in milliseconds; leave out --quality, "
        "--seconds-per-frame and --preview");
  }
  if (arguments.shots.downscale && *arguments.shots.downscale < 1) {
    throw InputError("--downscale {}: use 1 or more", *arguments.shots.downscale);
  }
  if (arguments.seconds_per_frame && !(*arguments.seconds_per_frame > 0)) {
    throw InputError("--seconds-per-frame {}: use more than 0", *arguments.seconds_per_frame);
  }
  if (!(arguments.quality >= 0 && arguments.quality <= 1)) {
    throw InputError("--quality {}: use 0 (fast) to 1 (exact)", arguments.quality);
  }
  if (arguments.fps && !(*arguments.fps > 0 && *arguments.fps <= 1000)) {
    throw InputError("--fps {}: use more than 0, at most 1000", *arguments.fps);
  }
}

// Renders all views; with --preview each one coarse first.
void RenderShots(const OpenedRun& run, bool uses_splats, const ShotList& list,
                 const RenderArguments& arguments, const fs::path& output) {
  const SceneFacts& scene = run.model->Scene();
  std::optional<std::array<float, 3>> gains;
  if (!arguments.exposure_of.empty()) {
    gains = GainsOf(run.model->GetModel(), arguments.exposure_of);
  }
  const double quality = ChooseQuality(run, list.shots.front(), arguments, uses_splats);
  const auto model = ChosenModel(run, uses_splats, arguments.run);
  const Eigen::Vector3f background = DisplayBackground(scene.has_alpha);
  std::int64_t pixels = 0, done = 0;
  for (const Shot& shot : list.shots) {
    pixels += static_cast<std::int64_t>(shot.camera.width) * shot.camera.height;
  }
  ProgressLine progress("rendering", pixels);
  for (const Shot& shot : list.shots) {
    for (const int factor : {8, 4}) {
      if (!arguments.preview) break;
      WriteImage(
          output / (shot.name + "." + arguments.files.format),
          RenderPreview(*run.model->Renderer(quality), shot.camera, factor,
                        scene.normalized_from_world.NormalizedFromCamera(shot.world_from_camera),
                        background, scene.encoding));
    }
    RenderedView view =
        model->Render({shot.camera, shot.world_from_camera, quality,
                       [&](std::int64_t of_view) { progress.Update(done + of_view, shot.name); },
                       arguments.files.surface});
    done += static_cast<std::int64_t>(shot.camera.width) * shot.camera.height;
    if (gains) Expose(*gains, background, view);
    WriteView(view, scene, arguments.files, output / shot.name);
  }
}

void WriteFilm(const ShotList& list, const RenderArguments& arguments, const fs::path& output) {
  if (!list.frames_per_second || arguments.no_video) return;
  if (arguments.files.format != "png" || !FfmpegIsInstalled()) {
    fmt::print("no film.mp4: it needs --format png and the ffmpeg program\n");
    return;
  }
  const fs::path film = output / "film.mp4";
  WriteVideo(output, static_cast<int>(list.shots.size()),
             arguments.fps.value_or(*list.frames_per_second), film);
  fmt::print("{}\n", film.string());
}

// Draws Gaussians that this or another program has written as PLY.
void RenderPly(const RenderArguments& arguments) {
  if (arguments.with == "field" || arguments.preview || arguments.quality != 1 ||
      arguments.seconds_per_frame || !arguments.exposure_of.empty()) {
    throw InputError(
        "{}: is drawn exactly, and has no field and no photographs; leave out --with field, "
        "--quality, --seconds-per-frame, --preview and --exposure-of",
        arguments.run);
  }
  if (arguments.output.empty()) throw InputError("{}: give a folder with -o", arguments.run);
  const ShotList list = ChoosePlyShots(arguments.shots, arguments.run);
  const std::shared_ptr<const GaussianModel> model = OpenPly(arguments.run);
  MakeOutputFolder(arguments.output);
  for (const Shot& shot : list.shots) {
    WriteView(model->Render({shot.camera, shot.world_from_camera, 1, {}, arguments.files.surface}),
              model->Scene(), arguments.files, fs::path(arguments.output) / shot.name);
  }
  fmt::print("{} views in {}\n", list.shots.size(), arguments.output);
  WriteFilm(list, arguments, arguments.output);
}

void RunRender(const RenderArguments& arguments) {
  UseThreads(arguments.threads);
  CheckArguments(arguments);
  if (fs::path(arguments.run).extension() == ".ply") {
    RenderPly(arguments);
    return;
  }
  const OpenedRun run = OpenRun(arguments.run);
  // The ways to save time are those of the field.
  const bool is_field = arguments.with == "auto" && (arguments.preview || arguments.quality != 1);
  const bool uses_splats = !is_field && UsesSplats(arguments.with, arguments.run);
  ChosenModel(run, uses_splats, arguments.run);  // throws before a folder is created
  if (arguments.files.surface && !uses_splats) {
    throw InputError("--surface: median depth and normals are of Gaussians; use --with splats");
  }
  if (!arguments.exposure_of.empty()) GainsOf(run.model->GetModel(), arguments.exposure_of);
  const ShotList list = ChooseShots(run, arguments.shots, arguments.run);
  const fs::path output = arguments.output.empty()
                              ? fs::path(arguments.run) / "renders" / list.folder
                              : fs::path(arguments.output);
  MakeOutputFolder(output);
  for (const Shot& shot : list.shots) {
    CheckCameraCentre(run.model->Scene()
                          .normalized_from_world.NormalizedFromCamera(shot.world_from_camera)
                          .translation(),
                      shot.name);
  }
  if (!arguments.channels.channels.empty()) {
    RenderChannels(run, arguments.run, arguments.channels, list, output);
    fmt::print("{} views in {}\n", list.shots.size(), output.string());
    return;
  }
  RenderShots(run, uses_splats, list, arguments, output);
  fmt::print("{} views in {}\n", list.shots.size(), output.string());
  WriteFilm(list, arguments, output);
}

}  // namespace

void AddRenderCommand(CLI::App& app) {
  auto* command = app.add_subcommand("render", "Renders new views of a trained run");
  const auto arguments = std::make_shared<RenderArguments>();
  command->add_option("run", arguments->run, "run folder, or a PLY file of Gaussians")->required();
  command->add_option("-o,--output", arguments->output, "output folder [RUN/renders/...]");
  AddModelChoice(*command, arguments->with);
  auto* image =
      command->add_option("--image", arguments->shots.image, "the view of this photograph");
  auto* pose = command->add_option("--pose", arguments->shots.pose,
                                   "one pose: JSON with transform_matrix or camera_to_world");
  auto* path = command->add_option("--path", arguments->shots.path,
                                   "orbit, spiral, training, or nerfstudio's camera_path.json");
  image->excludes(pose)->excludes(path);
  pose->excludes(path);
  command->add_option("--frames", arguments->shots.frames, "number of views along the path")
      ->capture_default_str();
  command->add_option("--fps", arguments->fps, "frames per second of the film");
  command->add_option(
      "--downscale", arguments->shots.downscale,
      "reduce the resolution by this factor [as trained; 1 for --pose and a path file]");
  AddViewFiles(*command, arguments->files);
  AddChannelOptions(*command, arguments->channels);
  command->add_flag("--preview", arguments->preview,
                    "write each image at coarse resolution first, then finer, then full");
  command->add_flag("--no-video", arguments->no_video, "do not make an MP4 of a path");
  auto* quality =
      command
          ->add_option("--quality", arguments->quality,
                       "0 (fast) to 1 (exact); costs and errors are in docs/rendering.md")
          ->capture_default_str();
  command
      ->add_option("--seconds-per-frame", arguments->seconds_per_frame,
                   "use the highest quality whose frames take at most this time")
      ->excludes(quality);
  command->add_option("--exposure-of", arguments->exposure_of,
                      "use the exposure of this photograph [mean of the training photographs]");
  command->add_option("--threads", arguments->threads, "0: all cores")->capture_default_str();
  command->footer(
      "Without --image, --pose or --path: the views of the held-out photographs.\n"
      "Examples:\n"
      "  nerf render runs/fox\n"
      "  nerf render runs/fox --path orbit --frames 60 --downscale 8\n"
      "  nerf render runs/fox --path orbit --seconds-per-frame 0.3\n"
      "  nerf render runs/fox --path orbit --with splats\n"
      "  nerf render runs/fox --pose pose.json --format exr --depth\n"
      "  nerf render runs/fox --path camera_path.json -o film\n"
      "  nerf render runs/mug --channel normal,albedo,roughness\n"
      "  nerf render scene.ply --pose pose.json -o views");
  command->callback([arguments] { RunRender(*arguments); });
}

}  // namespace nerf
