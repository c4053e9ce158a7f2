#include <spdlog/fmt/fmt.h>

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "nerf/base/input_error.h"
#include "nerf/base/stopwatch.h"
#include "nerf/capture/normal_truth.h"
#include "nerf/capture/photometric_folder.h"
#include "nerf/capture/photometric_maps.h"
#include "nerf/commands/choice_option.h"
#include "nerf/commands/commands.h"
#include "nerf/commands/input_encoding.h"
#include "nerf/commands/olat_flags.h"
#include "nerf/commands/threads.h"

namespace nerf {
namespace {

struct StereoArguments {
  std::string folder;
  std::string output;
  std::string truth;
  OlatOptions capture;
  StereoOptions stereo;
  int memory_mb = static_cast<int>(kObservationBytes >> 20);
  int threads = 0;

  void Check() const {
    stereo.Check();
    if (memory_mb < 1) throw InputError("--memory-mb is {}: choose 1 or more", memory_mb);
  }
};

void PrintError(const NormalError& error) {
  fmt::print("against the true normals: mean error {:.2f} degrees, median {:.2f}, of {} pixels\n",
             error.mean, error.median, error.pixels);
}

void RunPhotometricStereo(const StereoArguments& arguments) {
  const Stopwatch watch;
  arguments.Check();
  UseThreads(arguments.threads);
  const auto capture = FindOlatCapture(arguments.folder, arguments.capture);
  std::optional<Image> truth;  // read first, since a mistake in it should not cost the result
  if (!arguments.truth.empty()) {
    truth = ReadNormalTruth(arguments.truth);
    if (truth->width != capture.width || truth->height != capture.height) {
      throw InputError("--truth {}: {} x {} pixels, but the capture has {} x {}", arguments.truth,
                       truth->width, truth->height, capture.width, capture.height);
    }
  }
  const std::filesystem::path folder =
      arguments.output.empty() ? capture.name + "-normals" : arguments.output;
  CheckOutputFolder(capture, folder);
  const InputEncoding encoding = arguments.capture.encoding == InputEncoding::kAuto
                                     ? EncodingByResidual(capture)
                                     : arguments.capture.encoding;
  const auto maps = SolvePhotometricStereo(capture, encoding, arguments.stereo,
                                           std::int64_t{arguments.memory_mb} << 20);
  WritePhotometricFolder(folder, maps);
  const double share = 100.0 / std::max(1, maps.pixels);
  fmt::print(
      "{}: {} images, read as {}, lights from {}\n"
      "{} pixels: {:.1f} % by least squares, {:.1f} % robust, {:.1f} % unsolved\n"
      "median residual {:.2f} % of the albedo; {:.1f} s\n"
      "normals, albedo, residual, depth.ply and relit.png are in {}\n",
      capture.name, capture.images.size(), encoding == InputEncoding::kSrgb ? "sRGB" : "linear",
      capture.lights_source, maps.pixels,
      share * (maps.pixels - maps.robust_pixels - maps.unsolved_pixels), share * maps.robust_pixels,
      share * maps.unsolved_pixels, 100 * maps.median_residual, watch.Seconds(), folder.string());
  if (truth) PrintError(CompareNormals(maps.normal, *truth, arguments.truth));
}

}  // namespace

void AddPhotometricStereoCommand(CLI::App& app) {
  auto arguments = std::make_shared<StereoArguments>();
  CLI::App* command =
      app.add_subcommand("photometric-stereo",
                         "Computes normals and albedo from photographs under one light at a time");
  command
      ->add_option(
          "folder", arguments->folder,
          "images from one camera, one for each light; with lights.txt, light_directions.txt, "
          "an .lp file or a folder chrome")
      ->required();
  command->add_option("-o,--output", arguments->output, "output folder [NAME-normals]");
  AddLightsOption(*command, arguments->capture);
  command->add_option("--truth", arguments->truth,
                      "true normals, Normal_gt.mat or a picture of them: prints the mean error");
  AddInputEncodingOption(*command, arguments->capture.encoding,
                         "of the images: srgb, linear, or auto: 8-bit images as the one with the "
                         "smaller least-squares residual, others as linear");
  AddChoiceOption<StereoMethod>(
      *command, "--method", arguments->stereo.method,
      {{"auto", StereoMethod::kAuto},
       {"least-squares", StereoMethod::kLeastSquares},
       {"robust", StereoMethod::kRobust}},
      "least-squares, robust (against shadows and highlights), or auto: robust where "
      "the residual of least squares exceeds --residual");
  command
      ->add_option("--residual", arguments->stereo.max_residual,
                   "largest residual of least squares, relative to the albedo; above it, and in "
                   "shadow, auto uses the robust method")
      ->capture_default_str();
  command
      ->add_option(
          "--tolerance", arguments->stereo.tolerance,
          "of the robust method: larger residuals, relative to the brightest observation of a "
          "pixel, are shadows or highlights")
      ->capture_default_str();
  command
      ->add_option("--dark", arguments->stereo.dark,
                   "observations below this fraction of the brightest one of a pixel are in shadow")
      ->capture_default_str();
  command
      ->add_option("--memory-mb", arguments->memory_mb,
                   "memory for observations; if they do not fit, the images are read several times")
      ->capture_default_str();
  command->add_option("--threads", arguments->threads, "0: all cores")->capture_default_str();
  command->footer(
      "lights.txt: a line per image, \"x y z\", \"x y z intensity\" or \"x y z r g b\"; x right,\n"
      "y up, z towards the camera, after the name of the image or without it. An image with "
      "\"mask\" in\n"
      "its name is white on the subject. Folders of DiLiGenT and .lp files of RTI are read as they "
      "are.\n"
      "Examples:\n"
      "  nerf photometric-stereo photometric/cat\n"
      "  nerf photometric-stereo photometric/cat --lights chrome -o out/cat\n"
      "  nerf photometric-stereo vase --method robust --encoding linear\n"
      "  nerf photometric-stereo ballPNG --truth ballPNG/Normal_gt.mat");
  command->callback([arguments] { RunPhotometricStereo(*arguments); });
}

}  // namespace nerf
