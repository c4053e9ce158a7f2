#include "nerf/capture/relight.h"

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "nerf/base/atomic_file.h"
#include "nerf/base/input_error.h"
#include "nerf/base/interrupt.h"
#include "nerf/base/stopwatch.h"
#include "nerf/commands/commands.h"
#include "nerf/commands/environment_option.h"
#include "nerf/commands/input_encoding.h"
#include "nerf/commands/olat_flags.h"
#include "nerf/commands/relight_run.h"
#include "nerf/commands/relight_run_flags.h"
#include "nerf/commands/threads.h"
#include "nerf/image/image_io.h"
#include "nerf/image/image_metrics.h"
#include "nerf/light/light_name.h"
#include "nerf/output/video.h"

namespace nerf {
namespace {

namespace fs = std::filesystem;

constexpr double kFramesPerSecond = 24;
constexpr std::size_t kMinLights = 3;
constexpr double kMaxStops = 64;         // beyond it floats overflow
constexpr double kMaxUncovered = 0.001;  // of the power of the environment, without a warning

struct RelightArguments {
  std::string capture;
  std::string output;
  std::vector<std::string> environments;
  OlatOptions olat;
  double rotate = 0;  // degrees
  int frames = 0;
  std::optional<double> exposure;  // stops
  std::string truth;
  int memory_mb = 1024;
  int threads = 0;
  RelightRunFlags of_run;

  void Check() const {
    if (frames < 0 || frames > 10'000) {
      throw InputError("--frames is {}: choose a number from 1 to 10000", frames);
    }
    if (!(std::abs(rotate) <= 360)) {
      throw InputError("--rotate is {}: choose -360 to 360 degrees", rotate);
    }
    if (exposure && !(std::abs(*exposure) <= kMaxStops)) {
      throw InputError("--exposure is {}: choose -{} to {} stops", *exposure, kMaxStops, kMaxStops);
    }
    if (memory_mb < 1) throw InputError("--memory-mb is {}: choose 1 or more", memory_mb);
    if (frames > 0 && !FfmpegIsInstalled()) {
      throw InputError("--frames needs the program ffmpeg: install it");
    }
    if (IsRun(capture)) {
      CheckForRun();
      return;
    }
    if (of_run.UsesAny()) {
      throw InputError(
          "{}: is no trained run; --image, --pose, --path, --downscale, --bounces, --edit and "
          "--background are of runs",
          capture);
    }
    if (environments.size() != 1) throw InputError("give one --environment");
  }

  void CheckForRun() const {
    if (!truth.empty() || olat.lights == LightCalibration::kChromeBall ||
        olat.encoding != InputEncoding::kAuto) {
      throw InputError(
          "{}: is a trained run; --truth, --lights chrome and --encoding are of light-stage "
          "captures",
          capture);
    }
    if (environments.empty() && olat.lights != LightCalibration::kFile) {
      throw InputError("give --environment, or --lights with a lights.json");
    }
  }
};

// Called before the images are summed, so that a wrong file is reported at once.
Image OpenTruth(const fs::path& file, const OlatCapture& capture) {
  Image truth = ReadLinearImage(file, InputEncoding::kAuto);
  if (truth.width == capture.width && truth.height == capture.height) return truth;
  throw InputError("--truth {}: {} x {} pixels, but the capture has {} x {}", file.string(),
                   truth.width, truth.height, capture.width, capture.height);
}

OlatCapture OpenCapture(const RelightArguments& arguments) {
  OlatCapture capture = FindOlatCapture(arguments.capture, arguments.olat);
  if (capture.lights.size() < kMinLights) {
    throw InputError("{}: images under {} light{}; relighting needs at least {}", arguments.capture,
                     capture.lights.size(), capture.lights.size() == 1 ? "" : "s", kMinLights);
  }
  return capture;
}

// The weights of the images for each frame. Warns if the capture has no lights where a noticeable
// part of the light comes from.
std::vector<std::vector<Color>> WeightsOfFrames(const RelightArguments& arguments,
                                                const OlatCapture& capture,
                                                const LightVoronoi& cells,
                                                const EnvironmentMap& map, int frames) {
  std::vector<std::vector<Color>> weights;
  double uncovered = 0;
  for (int f = 0; f < frames; ++f) {
    const double degrees = arguments.rotate + 360.0 * f / frames;
    weights.push_back(RelightWeights(capture, cells, map, degrees));
    uncovered = std::max(uncovered, cells.UncoveredFraction(map, degrees));
  }
  if (uncovered > kMaxUncovered) {
    spdlog::warn(
        "{}{:.1f} % of the light of {} comes from directions without a light in the capture and is "
        "left out",
        frames > 1 ? "up to " : "", 100 * uncovered, arguments.environments.front());
  }
  return weights;
}

RelightRunArguments ForRun(const RelightArguments& arguments) {
  const RelightRunFlags& flags = arguments.of_run;
  RelightRunArguments of_run;
  of_run.run = arguments.capture;
  of_run.output = arguments.output;
  of_run.environments = arguments.environments;
  if (arguments.olat.lights == LightCalibration::kFile) {
    of_run.lights = arguments.olat.light_file.string();
  }
  of_run.edit = flags.edit;
  of_run.rotate = arguments.rotate;
  of_run.exposure = arguments.exposure;
  of_run.bounces = flags.bounces.value_or(of_run.bounces);
  of_run.shows_map = flags.background == "map";
  of_run.shots = flags.shots;
  if (arguments.frames > 0 && flags.shots.path.empty()) {
    of_run.turning_frames = arguments.frames;
  } else if (arguments.frames > 0) {
    of_run.shots.frames = arguments.frames;
  }
  return of_run;
}

void RunRelight(const RelightArguments& arguments) {
  const Stopwatch watch;
  arguments.Check();
  UseThreads(arguments.threads);
  if (IsRun(arguments.capture)) {
    RelightRun(ForRun(arguments));
    return;
  }
  const auto& stop = StopOnInterrupt();
  const OlatCapture capture = OpenCapture(arguments);
  const fs::path folder = arguments.output.empty() ? capture.name + "-relit" : arguments.output;
  CheckOutputFolder(capture, folder);
  std::optional<Image> truth;
  if (!arguments.truth.empty()) truth = OpenTruth(arguments.truth, capture);
  const EnvironmentMap map = OpenEnvironment(arguments.environments.front());
  CheckNotBlack(capture, arguments.olat.encoding);
  const LightVoronoi cells(capture.lights,
                           CellRows(static_cast<int>(capture.lights.size()), map.height()));
  const int frames = std::max(1, arguments.frames);
  const auto weights = WeightsOfFrames(arguments, capture, cells, map, frames);
  const fs::path frame_folder = folder / "frames";
  MakeOutputFolder(arguments.frames > 0 ? frame_folder : folder);
  // One exposure for the whole film, from its first frame.
  std::optional<double> stops = arguments.exposure;
  std::optional<double> psnr;
  const bool finished = Relight(
      capture, arguments.olat.encoding, weights, std::int64_t{arguments.memory_mb} << 20,
      [&] { return !stop; },
      [&](int frame, const Image& picture) {
        if (!stops) stops = AutoExposure(picture);
        if (frame == 0) {
          if (truth) psnr = Psnr(WithExposure(*truth, *stops), WithExposure(picture, *stops));
          WriteImage(folder / "relit.exr", picture);
          WriteImage(folder / "relit.png", WithExposure(picture, *stops));
        }
        if (arguments.frames > 0) {
          WriteImage(frame_folder / FrameName(frame), WithExposure(picture, *stops));
        }
      });
  if (!finished) {
    fmt::print("stopped; the finished pictures are in {}\n", folder.string());
    throw CLI::RuntimeError(130);
  }
  if (arguments.frames > 0) {
    WriteVideo(frame_folder, frames, kFramesPerSecond, folder / "rotation.mp4");
  }
  fmt::print(
      "{}: {} lights{}, {} x {} pixels, {} picture{} at {:+.2f} stops in {:.1f} s\n"
      "relit.png and relit.exr (linear){} are in {}\n",
      capture.name, capture.lights.size(), cells.on_a_grid() ? " on a grid" : "", capture.width,
      capture.height, frames, frames == 1 ? "" : "s", *stops, watch.Seconds(),
      arguments.frames > 0 ? " and rotation.mp4" : "", folder.string());
  if (psnr) fmt::print("PSNR {:.2f} dB against {}\n", *psnr, arguments.truth);
}

}  // namespace

void AddRelightCommand(CLI::App& app) {
  auto arguments = std::make_shared<RelightArguments>();
  CLI::App* command = app.add_subcommand(
      "relight", "Renders a trained run, or a light-stage capture, under an environment");
  command
      ->add_option("capture", arguments->capture,
                   "a run with materials; or a folder with an image for each light, and lights.txt "
                   "or a folder chrome")
      ->required();
  command
      ->add_option(
          "--environment", arguments->environments,
          fmt::format("an HDR or EXR map, twice as wide as high, or a named light: {}; for a run "
                      "there may be several",
                      kLightNames))
      ->allow_extra_args(false)
      ->take_all();
  command->add_option("-o,--output", arguments->output,
                      "output folder [RUN/relit/MAP, or NAME-relit]");
  command
      ->add_option("--rotate", arguments->rotate,
                   "rotation of the environment about the vertical axis, degrees")
      ->capture_default_str();
  command->add_option(
      "--frames", arguments->frames,
      "number of frames of a film, of one full rotation of the environment or of --path; needs "
      "ffmpeg");
  command->add_option("--exposure", arguments->exposure,
                      "exposure of the PNG in stops [bright parts just below white]");
  command->add_option(
      "--truth", arguments->truth,
      "a picture rendered directly under the environment, to compute the PSNR against");
  AddRelightRunFlags(*command, arguments->of_run);
  AddLightsOption(*command, arguments->olat);
  AddInputEncodingOption(*command, arguments->olat.encoding,
                         "of the images: srgb, linear, or auto: 8-bit images as srgb, others as "
                         "linear");
  command->add_option("--memory-mb", arguments->memory_mb, "memory for pixels")
      ->capture_default_str();
  command->add_option("--threads", arguments->threads, "0: all cores")->capture_default_str();
  command->footer(
      "Examples:\n"
      "  nerf materials runs/chair                           finds the materials of a run\n"
      "  nerf relight runs/chair --environment venice_sunset_1k.hdr\n"
      "  nerf relight runs/chair --environment D65 --path orbit --frames 72\n"
      "  nerf relight runs/chair --environment sky.hdr --image r_5.png --frames 72 --background "
      "map\n"
      "  nerf relight runs/chair --lights lights.json --edit edits.json\n"
      "  nerf sample stage --light-stage 256                 makes such a capture\n"
      "  nerf relight stage --environment venice_sunset_1k.hdr\n"
      "  nerf relight stage --environment venice_sunset_1k.hdr --frames 72\n"
      "  nerf relight stage --environment blackbody:3200 --exposure 0");
  command->callback([arguments] { RunRelight(*arguments); });
}

}  // namespace nerf
