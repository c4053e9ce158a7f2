#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "nerf/base/atomic_file.h"
#include "nerf/base/input_error.h"
#include "nerf/base/progress.h"
#include "nerf/commands/commands.h"
#include "nerf/commands/training_display.h"
#include "nerf/pipeline/prepared_scene.h"
#include "sfm/colmap_runner.h"
#include "sfm/colmap_text_writer.h"
#include "sfm/film.h"
#include "sfm/masks.h"
#include "sfm/pose_error.h"
#include "sfm/pose_input.h"
#include "sfm/sparse_points.h"
#include "sfm/transforms_json.h"

namespace nerf {
namespace {

namespace fs = std::filesystem;

struct PosesArguments {
  std::string folder;
  std::string output;
  int frames = 0;
  bool keep_poses = false;
  std::string truth;
  sfm::ColmapOptions colmap;
};

void PrintReport(const sfm::ColmapReport& report, const fs::path& transforms) {
  const auto row = [](const std::string& what, const std::string& value) {
    fmt::print("{:<26}{}\n", what, value);
  };
  row("photographs", fmt::format("{}", report.photos));
  row("registered", fmt::format("{}", report.registered));
  for (const std::string& name : report.unregistered) row("  not registered", name);
  row("skipped", fmt::format("{}", report.skipped.size()));
  for (const sfm::SkippedPhoto& photo : report.skipped) {
    row("  skipped", fmt::format("{} ({})", photo.name, photo.reason));
  }
  row("points", fmt::format("{}", report.points));
  row("mean reprojection error", fmt::format("{:.2f} pixels", report.mean_reprojection_error));
  row("verdict", sfm::Describe(report.verdict));
  double total = 0;
  for (const auto& [step, seconds] : report.seconds) {
    row("seconds, " + step, fmt::format("{:.1f}", seconds));
    total += seconds;
  }
  row("seconds, total", fmt::format("{:.1f}", total));
  row("poses", transforms.string());
}

// The folder of the photographs, to which their names are relative.
fs::path ImageFolder(const PosedImages& posed) {
  const fs::path root = RootOf(posed.images.front());
  for (const PosedImage& image : posed.images) {
    if (RootOf(image) == root) continue;
    throw InputError("{}: its photographs are in several folders, {} and {}; put them into one",
                     posed.source.string(), root.string(), RootOf(image).string());
  }
  return fs::absolute(root).lexically_normal();
}

// Refuses an output that would replace something, before any work.
void CheckOutput(const fs::path& output, const fs::path& photographs) {
  const fs::path link = fs::absolute(output / "images").lexically_normal();
  if (link == photographs || (fs::exists(link) && !fs::is_symlink(link))) {
    throw InputError("{}: holds photographs; choose another folder with -o", link.string());
  }
  if (fs::exists(output / "transforms.json")) {
    throw InputError(
        "{}: has a transforms.json, which would be read instead of the points; choose "
        "another folder with -o",
        output.string());
  }
}

// What a COLMAP model cannot say is lost, and better said.
void WarnAboutLosses(const PosedImages& posed) {
  const auto any = [&](auto has) { return std::ranges::any_of(posed.images, has); };
  const bool splits = any([](const PosedImage& i) { return i.split != Split::kUnspecified; });
  const bool masks = any([](const PosedImage& i) { return !i.mask.empty(); });
  const bool turned = any([](const PosedImage& i) { return i.upright_by_exif; });
  if (!splits && !masks && !turned) return;
  spdlog::warn(
      "{}: the COLMAP model does not keep its{}{}{}; nerf train on the input itself finds "
      "points and keeps them",
      posed.source.string(), splits ? " division into training and test views" : "",
      masks ? " masks" : "", turned ? " rotation by EXIF" : "");
}

// Finds sparse points for poses that are given.
void KeepPoses(const PosesArguments& arguments, const fs::path& output) {
  arguments.colmap.Check();
  PosedImages posed = sfm::ReadPosedInput(sfm::FindInput(arguments.folder));
  TrainingDisplay display;
  ReportMissing(posed, [&](const PipelineEvent& event) { display(event); });
  sfm::FindMasks(posed);
  const fs::path photographs = ImageFolder(posed);
  CheckOutput(output, photographs);
  WarnAboutLosses(posed);
  const fs::path workspace = output / "points", model = output / "sparse" / "0";
  const sfm::SparsePointReport report = sfm::FindSparsePoints(posed, workspace, arguments.colmap);
  if (report.consistency.Contradicts()) {
    throw InputError("{}: {}", posed.source.string(), sfm::Describe(report.consistency));
  }
  MakeOutputFolder(model);
  std::error_code error;
  fs::remove(output / "images", error);  // of an earlier call
  fs::create_directory_symlink(photographs, output / "images", error);
  if (error) {
    throw InputError("{}: cannot be made: {}", (output / "images").string(), error.message());
  }
  sfm::WriteColmapText(posed, model);
  fmt::print("{}\n{}\n{:<26}{}\n", sfm::Describe(report.consistency), sfm::Describe(report),
             "poses and points", output.string());
}

void PrintErrors(const PosedImages& found, const fs::path& truth) {
  const sfm::PoseErrors errors = sfm::ComparePoses(found, sfm::ReadTransformsJson(truth));
  fmt::print("{:<26}{:.3f} degrees, {:.3f} at most\n{:<26}{:.3f} %, {:.3f} % at most\n",
             "rotation error, median", errors.rotation_median, errors.rotation_largest,
             "position error, median", 100 * errors.position_median, 100 * errors.position_largest);
}

void RunPoses(const PosesArguments& arguments) {
  fs::path folder = fs::absolute(arguments.folder).lexically_normal();
  if (!folder.has_filename()) folder = folder.parent_path();  // a trailing slash
  const std::optional<fs::path> film = sfm::FindFilm(arguments.folder);
  if (sfm::HasFilmExtension(folder)) folder.replace_extension();
  if (folder.extension() == ".json") folder = folder.parent_path();
  const fs::path output = arguments.output.empty()
                              ? fs::path("runs") / (folder.filename().string() + "-poses")
                              : fs::path(arguments.output);
  if (arguments.keep_poses) return KeepPoses(arguments, output);
  const fs::path transforms = output / "transforms.json";
  const fs::path workspace = output / "colmap";
  if (fs::exists(transforms) && !fs::exists(workspace / "steps.json")) {
    throw InputError(
        "{}: already exists and was not written by nerf poses; choose another folder with -o",
        transforms.string());
  }
  sfm::ColmapReport report;
  sfm::ColmapOptions colmap = arguments.colmap;
  fs::path photos = arguments.folder;
  if (film) {
    photos = output / "frames";
    MakeOutputFolder(output);
    const sfm::FilmFrames frames = sfm::ExtractFrames(*film, photos, arguments.frames);
    fmt::print("{}: {}\n", film->string(), DescribeFrames(frames, photos));
    std::fflush(stdout);
    if (colmap.matcher == "auto") colmap.matcher = "sequential";
  }
  const PosedImages posed = sfm::PosesFromPhotos(photos, workspace, colmap, &report);
  sfm::WriteTransformsJson(posed, transforms);
  PrintReport(report, transforms);
  if (!arguments.truth.empty()) PrintErrors(posed, arguments.truth);
}

}  // namespace

void AddPosesCommand(CLI::App& app) {
  auto* command =
      app.add_subcommand("poses", "Finds the camera poses of a folder of photographs, with COLMAP");
  const auto arguments = std::make_shared<PosesArguments>();
  sfm::ColmapOptions& colmap = arguments->colmap;
  command
      ->add_option("INPUT", arguments->folder,
                   "Folder of photographs, or a film; with --keep-poses what nerf train reads")
      ->required();
  command->add_option("-o,--output", arguments->output,
                      "Folder for transforms.json and colmap/; default: runs/<name>-poses");
  command
      ->add_option("--matcher", colmap.matcher,
                   "Which pairs are matched: auto, exhaustive (all), sequential (neighbours),\n"
                   "guided (the most similar ones)")
      ->capture_default_str();
  command->add_option("--camera-model", colmap.camera_model, "COLMAP's name of the camera model")
      ->capture_default_str();
  command
      ->add_option("--max-image-size", colmap.max_image_size,
                   "Longer side, in pixels, to which photographs are reduced for features")
      ->capture_default_str();
  command
      ->add_option("--max-features", colmap.max_num_features,
                   "Features per photograph; the time to match grows with the square")
      ->capture_default_str();
  command
      ->add_option("--frames", arguments->frames,
                   "Frames to use of a film; 0: three a second, 40 to 150")
      ->check(CLI::Range(0, 10000))
      ->capture_default_str();
  command->add_flag(
      "--keep-poses", arguments->keep_poses,
      "INPUT has poses (transforms.json, COLMAP, LLFF): keep them, compare them with\n"
      "the photographs, and find sparse points");
  command
      ->add_option(
          "--truth", arguments->truth,
          "transforms.json of true poses: print the errors of those that were found, after\n"
          "alignment; positions relative to the cameras' mean distance from their centre")
      ->check(CLI::ExistingFile);
  command->add_option("--threads", colmap.threads, "Threads; 0: all cores")->capture_default_str();
  for (const char* of_new_poses : {"--matcher", "--frames", "--truth"}) {
    command->get_option("--keep-poses")->excludes(command->get_option(of_new_poses));
  }
  command->footer(
      "After an interruption, run it again to continue; finished steps are skipped.\n"
      "Examples:\n"
      "  nerf poses photos/fox\n"
      "  nerf poses photos/fox -o fox-poses --max-image-size 3200\n"
      "  nerf poses clip.mp4 --frames 120\n"
      "  nerf poses scene/transforms.json --keep-poses -o scene-points\n"
      "  nerf poses frames --matcher sequential --camera-model OPENCV_FISHEYE");
  command->callback([arguments] { RunPoses(*arguments); });
}

}  // namespace nerf
