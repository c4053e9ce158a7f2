#include <spdlog/fmt/fmt.h>

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "nerf/base/input_error.h"
#include "nerf/base/stopwatch.h"
#include "nerf/capture/photometric_folder.h"
#include "nerf/capture/photometric_maps.h"
#include "nerf/commands/choice_option.h"
#include "nerf/commands/commands.h"
#include "nerf/commands/input_encoding.h"
#include "nerf/commands/threads.h"

namespace nerf {
namespace {

struct StereoArguments {
  std::string folder;
  std::string output;
  OlatOptions capture;
  StereoOptions stereo;
  int memory_mb = static_cast<int>(kObservationBytes >> 20);
  int threads = 0;

  void Check() const {
    stereo.Check();
    if (memory_mb < 1) throw InputError("--memory-mb is {}: choose 1 or more", memory_mb);
  }
};

void RunPhotometricStereo(const StereoArguments& arguments) {
  const Stopwatch watch;
  arguments.Check();
  UseThreads(arguments.threads);
  const auto capture = FindOlatCapture(arguments.folder, arguments.capture);
  const std::filesystem::path folder =
      arguments.output.empty() ? capture.name + "-normals" : arguments.output;
  RefuseAmongImages(capture, folder);
  const InputEncoding encoding = arguments.capture.encoding == InputEncoding::kAuto
                                     ? EncodingByResidual(capture)
                                     : arguments.capture.encoding;
  const auto maps = SolvePhotometricStereo(capture, encoding, arguments.stereo,
                                           std::int64_t{arguments.memory_mb} << 20);
  WritePhotometricFolder(folder, maps);
  const double share = 100.0 / std::max(1, maps.pixels);
  fmt::print(
      "{}: {} images, encoding {}, lights from {}\n"
      "{} pixels: {:.1f} % by least squares, {:.1f} % robust, {:.1f} % unsolved\n"
      "median residual {:.2f} % of the albedo; {:.1f} s\n"
      "wrote normals, albedo, residual, depth.ply and relit.png to {}\n",
      capture.name, capture.images.size(), encoding == InputEncoding::kSrgb ? "sRGB" : "linear",
      capture.lights_from, maps.pixels,
      share * (maps.pixels - maps.robust_pixels - maps.unknown_pixels), share * maps.robust_pixels,
      share * maps.unknown_pixels, 100 * maps.median_residual, watch.Seconds(), folder.string());
}

}  // namespace

void AddPhotometricStereoCommand(CLI::App& app) {
  auto arguments = std::make_shared<StereoArguments>();
  CLI::App* command = app.add_subcommand(
      "photometric-stereo", "Normals and albedo from photographs under one light at a time");
  command
      ->add_option("folder", arguments->folder,
                   "images of one camera, one per light; with lights.txt or a folder chrome")
      ->required();
  command->add_option("-o,--output", arguments->output, "output folder [NAME-normals]");
  command
      ->add_option("--lights", arguments->capture.lights,
                   "a file with one direction per line; chrome: from highlights on a chrome ball; "
                   "auto: lights.txt if it exists, else chrome")
      ->capture_default_str();
  AddInputEncodingOption(*command, arguments->capture.encoding,
                         "of the images: srgb, linear, or auto: for 8 bits the one with the "
                         "smaller least-squares residual, else linear");
  AddChoiceOption<StereoMethod>(
      *command, "--method", arguments->stereo.method,
      {{"auto", StereoMethod::kAuto},
       {"least-squares", StereoMethod::kLeastSquares},
       {"robust", StereoMethod::kRobust}},
      "least-squares, robust (against shadows and highlights), or auto: robust where the "
      "least-squares residual exceeds --residual");
  command
      ->add_option(
          "--residual", arguments->stereo.largest_residual,
          "least-squares residual, relative to the albedo, above which auto uses the robust "
          "method (it also does for pixels in the shadow of a light)")
      ->capture_default_str();
  command
      ->add_option("--tolerance", arguments->stereo.tolerance,
                   "robust method: residual, as a fraction of a pixel's brightest observation, "
                   "above which an observation is a shadow or a highlight")
      ->capture_default_str();
  command
      ->add_option("--dark", arguments->stereo.dark,
                   "fraction of a pixel's brightest observation below which it is in shadow")
      ->capture_default_str();
  command
      ->add_option("--memory-mb", arguments->memory_mb,
                   "limit for pixel observations; above it, pixels are processed in parts and "
                   "images are read once per part")
      ->capture_default_str();
  command->add_option("--threads", arguments->threads, "0: all cores")->capture_default_str();
  command->footer(
      "lights.txt has one line per image: \"x y z\", \"x y z intensity\" or \"x y z r g b\"; x "
      "right,\n"
      "y up, z towards the camera. An image with \"mask\" in its name is white on the subject.\n"
      "Examples:\n"
      "  nerf photometric-stereo photometric/cat\n"
      "  nerf photometric-stereo photometric/cat --lights chrome -o out/cat\n"
      "  nerf photometric-stereo vase --method robust --encoding linear");
  command->callback([arguments] { RunPhotometricStereo(*arguments); });
}

}  // namespace nerf
