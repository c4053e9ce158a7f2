#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "nerf/commands/commands.h"
#include "nerf/commands/threads.h"
#include "nerf/data/camera.h"
#include "nerf/data/dataset.h"
#include "nerf/data/image_io.h"
#include "nerf/output/camera_path.h"
#include "nerf/output/camera_path_json.h"
#include "nerf/output/color_map.h"
#include "nerf/output/video.h"
#include "nerf/render/image_renderer.h"
#include "nerf/sampling/rays.h"
#include "nerf/train/run_folder.h"
#include "nerf/train/view_renderer.h"
#include "sfm/atomic_file.h"
#include "sfm/input_error.h"
#include "sfm/progress.h"

namespace nerf {
namespace {

namespace fs = std::filesystem;

struct RenderArguments {
  std::string run;
  std::string output;
  std::string image;  // name of a photograph
  std::string pose;   // JSON file
  std::string path;   // orbit, spiral, training, or JSON file
  int frames = 120;
  std::optional<double> fps;
  std::optional<int> downscale;
  std::string format = "png";
  bool depth = false;
  bool opacity = false;
  bool no_video = false;
  bool preview = false;
  double quality = 1;
  int threads = 0;
};

// One picture to make, in the frame and units of the input.
struct Shot {
  std::string name;
  Eigen::Isometry3d world_from_camera;
  sfm::Camera camera;
};

struct ShotList {
  std::vector<Shot> shots;
  std::string folder;                       // below RUN/renders
  std::optional<double> frames_per_second;  // of a film
};

// "train/r_0.png" -> "train_r_0", "../images/0001.jpg" -> "images_0001"
std::string FileStem(const std::string& image_name) {
  std::string stem;
  for (const fs::path& part : fs::path(image_name).replace_extension().relative_path()) {
    if (part == "..") continue;
    stem += (stem.empty() ? "" : "_") + part.string();
  }
  return stem;
}

Shot ShotOf(const OpenedRun& run, const sfm::PosedImage& image, int downscale) {
  return {FileStem(image.name), image.world_from_camera,
          Downscaled(run.posed.cameras[image.camera], downscale)};
}

ShotList ShotsOfPath(const CameraPath& path, const std::string& folder, int downscale) {
  ShotList list{{}, folder, path.frames_per_second};
  for (const PathPose& pose : path.poses) {
    list.shots.push_back({fs::path(FrameName(static_cast<int>(list.shots.size()))).stem().string(),
                          pose.world_from_camera, Downscaled(pose.camera, downscale)});
  }
  return list;
}

// What the person asked for: one photograph's pose, a pose file, a path, or the held-out views.
ShotList ChooseShots(const OpenedRun& run, const RenderArguments& arguments) {
  const int trained = run.model.config.data.downscale;
  const int downscale = arguments.downscale.value_or(trained);
  if (!arguments.image.empty()) {
    const auto found = std::ranges::find_if(run.posed.images, [&](const auto& image) {
      return image.name == arguments.image || FileStem(image.name) == arguments.image;
    });
    if (found == run.posed.images.end()) {
      throw sfm::InputError("--image {}: the run has no such photograph; names stand in {}",
                            arguments.image, PosesPath(arguments.run).string());
    }
    return {{ShotOf(run, *found, downscale)}, "image", {}};
  }
  if (!arguments.pose.empty()) {
    const PathPose pose = ReadPose(arguments.pose, run.posed);
    return {{{fs::path(arguments.pose).stem().string(), pose.world_from_camera,
              Downscaled(pose.camera, arguments.downscale.value_or(1))}},
            "pose",
            {}};
  }
  const auto& normalized_from_world = run.model.scene.normalized_from_world;
  if (arguments.path == "orbit") {
    return ShotsOfPath(OrbitPath(run.posed, normalized_from_world, arguments.frames), "orbit",
                       downscale);
  }
  if (arguments.path == "spiral") {
    return ShotsOfPath(SpiralPath(run.posed, normalized_from_world, arguments.frames), "spiral",
                       downscale);
  }
  if (arguments.path == "training") {
    return ShotsOfPath(TrainingPath(run.posed, arguments.frames), "training", downscale);
  }
  if (!arguments.path.empty()) {
    return ShotsOfPath(ReadCameraPath(arguments.path), fs::path(arguments.path).stem().string(),
                       arguments.downscale.value_or(1));
  }
  ShotList list{{}, "held-out", {}};
  for (const sfm::PosedImage& image : run.posed.images) {
    if (image.split == sfm::Split::kTest) list.shots.push_back(ShotOf(run, image, downscale));
  }
  if (list.shots.empty()) {
    throw sfm::InputError("{}: the run holds out no images; use --path, --pose or --image",
                          arguments.run);
  }
  return list;
}

void WriteShot(const RenderedView& view, const SceneFacts& scene, const RenderArguments& arguments,
               const fs::path& stem) {
  WriteImage(stem.string() + "." + arguments.format, view.rgb);
  if (arguments.depth) {
    Image depth = view.depth;
    for (float& d : depth.pixels) {
      d = static_cast<float>(scene.normalized_from_world.LengthWorldFromNormalized(d));
    }
    WriteImage(stem.string() + ".depth.exr", depth);
    WriteImage(stem.string() + ".depth.png", ColorizeDepth(depth, view.opacity));
  }
  if (arguments.opacity) {
    Image opacity = view.opacity;
    opacity.encoding = ColorEncoding::kSrgb;  // a mask: numbers go into the file as they are
    WriteImage(stem.string() + ".opacity.png", opacity);
  }
}

void RunRender(const RenderArguments& arguments) {
  UseThreads(arguments.threads);
  if (arguments.downscale && *arguments.downscale < 1) {
    throw sfm::InputError("--downscale {}: use 1 or more", *arguments.downscale);
  }
  if (arguments.fps && !(*arguments.fps > 0 && *arguments.fps <= 1000)) {
    throw sfm::InputError("--fps {}: use more than 0, at most 1000", *arguments.fps);
  }
  const OpenedRun run = OpenRun(arguments.run);
  const std::shared_ptr<RayRenderer> renderer = ViewRenderer(run.model, arguments.quality);
  const SceneFacts& scene = run.model.scene;
  const ShotList list = ChooseShots(run, arguments);
  const fs::path output = arguments.output.empty()
                              ? fs::path(arguments.run) / "renders" / list.folder
                              : fs::path(arguments.output);
  sfm::MakeOutputFolder(output);

  std::int64_t pixels = 0, done = 0;
  for (const Shot& shot : list.shots) {
    pixels += static_cast<std::int64_t>(shot.camera.width) * shot.camera.height;
  }
  sfm::ProgressLine progress("rendering", pixels);
  for (const Shot& shot : list.shots) {
    const Eigen::Isometry3d normalized_from_camera =
        scene.normalized_from_world.NormalizedFromCamera(shot.world_from_camera);
    CheckCameraCentre(normalized_from_camera.translation(), shot.name);
    const Eigen::Vector3f background = DisplayBackground(scene.has_alpha);
    for (const int factor : {8, 4}) {
      if (!arguments.preview) break;
      WriteImage(output / (shot.name + "." + arguments.format),
                 RenderPreview(*renderer, shot.camera, factor, normalized_from_camera, background,
                               scene.encoding));
    }
    const RenderedView view =
        RenderView(*renderer, shot.camera, normalized_from_camera, background, scene.encoding,
                   [&](std::int64_t of_this) { progress.Update(done + of_this, shot.name); });
    done += static_cast<std::int64_t>(shot.camera.width) * shot.camera.height;
    WriteShot(view, scene, arguments, output / shot.name);
  }
  progress.Finish();
  fmt::print("{} views in {}\n", list.shots.size(), output.string());

  if (!list.frames_per_second || arguments.no_video) return;
  if (arguments.format != "png" || !FfmpegIsInstalled()) {
    fmt::print("no film: it needs --format png and the ffmpeg program\n");
    return;
  }
  const fs::path film = output / "film.mp4";
  WriteVideo(output, static_cast<int>(list.shots.size()),
             arguments.fps.value_or(*list.frames_per_second), film);
  fmt::print("{}\n", film.string());
}

}  // namespace

void AddRenderCommand(CLI::App& app) {
  auto* command = app.add_subcommand("render", "Renders views that no camera took");
  const auto arguments = std::make_shared<RenderArguments>();
  command->add_option("run", arguments->run, "run folder")->required();
  command->add_option("-o,--output", arguments->output, "where pictures go [RUN/renders/...]");
  auto* image = command->add_option("--image", arguments->image, "the view of this photograph");
  auto* pose = command->add_option("--pose", arguments->pose,
                                   "one pose: JSON with transform_matrix or camera_to_world");
  auto* path = command->add_option("--path", arguments->path,
                                   "orbit, spiral, training, or nerfstudio's camera_path.json");
  image->excludes(pose)->excludes(path);
  pose->excludes(path);
  command->add_option("--frames", arguments->frames, "pictures along the path")
      ->capture_default_str();
  command->add_option("--fps", arguments->fps, "frames a second of the film");
  command->add_option(
      "--downscale", arguments->downscale,
      "reduce the camera by this factor [as trained; 1 for --pose and a path file]");
  command->add_option("--format", arguments->format, "png, jpg, or exr (linear)")
      ->check(CLI::IsMember({"png", "jpg", "exr"}))
      ->capture_default_str();
  command->add_flag("--depth", arguments->depth,
                    "also depth along the ray: EXR in the input's units, and a picture");
  command->add_flag("--opacity", arguments->opacity, "also opacity, as PNG");
  command->add_flag("--preview", arguments->preview,
                    "write each picture coarse first, then finer, then whole");
  command->add_flag("--no-video", arguments->no_video, "make no MP4 of a path");
  command
      ->add_option("--quality", arguments->quality,
                   "0, fast, to 1, exact; what each costs stands in the README")
      ->capture_default_str();
  command->add_option("--threads", arguments->threads, "0: all cores")->capture_default_str();
  command->footer(
      "Without --image, --pose or --path: the views of the held-out photographs.\n"
      "Examples:\n"
      "  nerf render runs/fox\n"
      "  nerf render runs/fox --path orbit --frames 60 --downscale 8\n"
      "  nerf render runs/fox --pose pose.json --format exr --depth\n"
      "  nerf render runs/fox --path camera_path.json -o film");
  command->callback([arguments] { RunRender(*arguments); });
}

}  // namespace nerf
