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

#include "nerf/base/atomic_file.h"
#include "nerf/base/input_error.h"
#include "nerf/base/interrupt.h"
#include "nerf/base/stopwatch.h"
#include "nerf/commands/commands.h"
#include "nerf/commands/input_encoding.h"
#include "nerf/commands/threads.h"
#include "nerf/image/image_io.h"
#include "nerf/image/image_metrics.h"
#include "nerf/light/light_name.h"
#include "nerf/output/video.h"

namespace nerf {
namespace {

namespace fs = std::filesystem;

constexpr double kFramesPerSecond = 24;
constexpr std::size_t kFewestLights = 3;
constexpr double kMaxStops = 64;            // beyond it floats overflow
constexpr double kOmittedToReport = 0.001;  // share of the environment's power

struct RelightArguments {
  std::string capture;
  std::string output;
  std::string environment;
  OlatOptions olat;
  double rotate = 0;  // degrees
  int frames = 0;
  std::optional<double> exposure;  // stops
  std::string truth;
  int memory_mb = 1024;
  int threads = 0;

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
      throw InputError("--frames needs the ffmpeg program: install it");
    }
  }
};

// Reads a map from a file, or makes a uniform one from the name of a light.
EnvironmentMap OpenEnvironment(const std::string& name) {
  if (!fs::exists(name)) {
    if (const auto color = ColorOfLight(name)) return EnvironmentMap::Uniform(*color);
    throw InputError("--environment {}: neither a file nor the name of a light; names are {}", name,
                     kLightNames);
  }
  return EnvironmentMap::Read(name);
}

// Read before relighting, so that an invalid file is reported early.
Image OpenTruth(const fs::path& file, const OlatCapture& capture) {
  Image truth = ReadLinearImage(file, InputEncoding::kAuto);
  if (truth.width == capture.width && truth.height == capture.height) return truth;
  throw InputError("--truth {}: is {} x {} pixels, the capture's are {} x {}", file.string(),
                   truth.width, truth.height, capture.width, capture.height);
}

OlatCapture OpenCapture(const RelightArguments& arguments) {
  OlatCapture capture = FindOlatCapture(arguments.capture, arguments.olat);
  if (capture.lights.size() < kFewestLights) {
    throw InputError("{}: images under {} light{}; relighting needs {} or more", arguments.capture,
                     capture.lights.size(), capture.lights.size() == 1 ? "" : "s", kFewestLights);
  }
  return capture;
}

void RunRelight(const RelightArguments& arguments) {
  const Stopwatch watch;
  arguments.Check();
  UseThreads(arguments.threads);
  const auto& stop = StopOnInterrupt();
  const OlatCapture capture = OpenCapture(arguments);
  const fs::path folder = arguments.output.empty() ? capture.name + "-relit" : arguments.output;
  RefuseAmongImages(capture, folder);
  std::optional<Image> truth;
  if (!arguments.truth.empty()) truth = OpenTruth(arguments.truth, capture);
  const EnvironmentMap map = OpenEnvironment(arguments.environment);
  RefuseBlackCapture(capture, arguments.olat.encoding);
  const LightVoronoi cells(capture.lights,
                           CellRows(static_cast<int>(capture.lights.size()), map.height()));
  double omitted = 0;
  std::vector<std::vector<Color>> weights;
  const int frames = std::max(1, arguments.frames);
  for (int f = 0; f < frames; ++f) {
    const double degrees = arguments.rotate + 360.0 * f / frames;
    weights.push_back(RelightWeights(capture, cells, map, degrees));
    omitted = std::max(omitted, cells.ShareLeftOut(map, degrees));
  }
  if (omitted > kOmittedToReport) {
    spdlog::warn("{}: {}{:.1f} % of the light is from directions without lights and is omitted",
                 arguments.environment, frames > 1 ? "up to " : "", 100 * omitted);
  }
  const fs::path frame_folder = folder / "frames";
  MakeOutputFolder(arguments.frames > 0 ? frame_folder : folder);
  // The first frame determines the exposure of the whole film.
  std::optional<double> stops = arguments.exposure;
  std::optional<double> psnr;
  const bool finished = Relight(
      capture, arguments.olat.encoding, weights, std::int64_t{arguments.memory_mb} << 20,
      [&] { return !stop; },
      [&](int frame, const Image& picture) {
        if (!stops) stops = AutoExposure(picture);
        if (frame == 0) {
          if (truth) psnr = Psnr(Exposed(*truth, *stops), Exposed(picture, *stops));
          WriteImage(folder / "relit.exr", picture);
          WriteImage(folder / "relit.png", Exposed(picture, *stops));
        }
        if (arguments.frames > 0) {
          WriteImage(frame_folder / FrameName(frame), Exposed(picture, *stops));
        }
      });
  if (!finished) {
    fmt::print("stopped; finished images are in {}\n", folder.string());
    throw CLI::RuntimeError(130);
  }
  if (arguments.frames > 0) {
    WriteVideo(frame_folder, frames, kFramesPerSecond, folder / "rotation.mp4");
  }
  fmt::print(
      "{}: {} lights{}, {} x {} pixels, {} image{} at {:+.2f} stops in {:.1f} s\n"
      "wrote relit.png and relit.exr (linear){} to {}\n",
      capture.name, capture.lights.size(), cells.on_a_grid() ? " on a grid" : "", capture.width,
      capture.height, frames, frames == 1 ? "" : "s", *stops, watch.Seconds(),
      arguments.frames > 0 ? " and rotation.mp4" : "", folder.string());
  if (psnr) fmt::print("PSNR {:.2f} dB against {}\n", *psnr, arguments.truth);
}

}  // namespace

void AddRelightCommand(CLI::App& app) {
  auto arguments = std::make_shared<RelightArguments>();
  CLI::App* command = app.add_subcommand(
      "relight",
      "Relights a light-stage capture under an environment map: an image, or a film of its "
      "rotation");
  command
      ->add_option("capture", arguments->capture,
                   "folder with one image per light, and lights.txt or a folder chrome")
      ->required();
  command
      ->add_option("--environment", arguments->environment,
                   std::string("HDR or EXR map, twice as wide as high, or the name of a light: ") +
                       kLightNames)
      ->required();
  command->add_option("-o,--output", arguments->output, "output folder [NAME-relit]");
  command
      ->add_option("--rotate", arguments->rotate,
                   "rotate the environment about the vertical, degrees")
      ->capture_default_str();
  command->add_option("--frames", arguments->frames,
                      "frames of a film of one full rotation (needs ffmpeg)");
  command->add_option("--exposure", arguments->exposure,
                      "exposure of the PNG, stops [bright parts just below white]");
  command->add_option("--truth", arguments->truth,
                      "image rendered directly under the environment, for the PSNR");
  command->add_option("--lights", arguments->olat.lights, "a light file, chrome, or auto")
      ->capture_default_str();
  AddInputEncodingOption(*command, arguments->olat.encoding,
                         "of the images: srgb, linear, or auto: 8 bits are srgb, others linear");
  command->add_option("--memory-mb", arguments->memory_mb, "limit for pixels")
      ->capture_default_str();
  command->add_option("--threads", arguments->threads, "0: all cores")->capture_default_str();
  command->footer(
      "Examples:\n"
      "  nerf sample stage --light-stage 256                 makes such a capture\n"
      "  nerf relight stage --environment venice_sunset_1k.hdr\n"
      "  nerf relight stage --environment venice_sunset_1k.hdr --frames 72\n"
      "  nerf relight stage --environment blackbody:3200 --exposure 0");
  command->callback([arguments] { RunRelight(*arguments); });
}

}  // namespace nerf
