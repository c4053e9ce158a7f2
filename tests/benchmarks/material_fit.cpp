// Takes a trained run apart, and compares with the truth in the manner of TensoIR:
//   material_fit RUN TRUTH STEPS [known] [resolution=N] [blur=CELLS] [material option=value ...]
// TRUTH is a folder like relight_totem: transforms_test.json with "lights" and for each frame
// "gt" and relit pictures, and ../environments with the maps. With `known` the light of the first
// map is given. Prints normal error (degrees, over the mask of the truth), albedo and relit PSNR
// (sRGB, before white; albedo after one scale a channel, the median of truth / found over the
// pixels of all test views), and seconds.
#include "nerf/train/material_fit.h"

#include <fmt/core.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "nerf/base/peak_memory.h"
#include "nerf/base/stopwatch.h"
#include "nerf/model/run_folder.h"
#include "nerf/pipeline/surface_extraction.h"
#include "nerf/relight/environment_light.h"
#include "nerf/scene/dataset.h"
#include "tests/benchmarks/material_truth.h"

namespace nerf {
namespace {

namespace fs = std::filesystem;

struct Arguments {
  fs::path run, truth;
  int steps = 0;
  bool is_light_known = false;
  MaterialOptions fit;
  SurfaceExtractionOptions surface;
};

Arguments Parse(int argc, char** argv) {
  Arguments arguments;
  if (argc < 4) throw std::runtime_error("material_fit RUN TRUTH STEPS [known] [option=value ...]");
  arguments.run = argv[1];
  arguments.truth = argv[2];
  arguments.steps = std::stoi(argv[3]);
  for (int i = 4; i < argc; ++i) {
    const std::string option = argv[i];
    const auto at = option.find('=');
    const std::string name = option.substr(0, at);
    bool found = name == "known" || name == "resolution" || name == "blur";
    const double value = at == std::string::npos ? 0 : std::stod(option.substr(at + 1));
    if (name == "known") arguments.is_light_known = true;
    if (name == "resolution") arguments.surface.resolution = static_cast<int>(value);
    if (name == "blur") arguments.surface.blur = value;
    MaterialOptions::Options(arguments.fit, [&](const char* key, auto& field, const auto&...) {
      if (name != key) return;
      field = static_cast<std::remove_reference_t<decltype(field)>>(value);
      found = true;
    });
    if (!found) throw std::runtime_error(option);
  }
  return arguments;
}

void Run(int argc, char** argv) {
  const Arguments arguments = Parse(argc, argv);
  const Stopwatch watch;
  const OpenedRun run = OpenRun(arguments.run);
  const SceneNormalization& frame = run.model->Scene().normalized_from_world;
  const Dataset data = LoadDataset(run.posed, run.model->GetConfig().data, {}, frame);
  std::vector<TargetView> targets = TargetViewsOf(data.train);
  const ExtractedSurface surface =
      *ExtractSurface(*run.model, targets, arguments.surface, false, [](std::size_t) {});
  fmt::print("surface of {} vertices, {:.1f} s\n", surface.mesh.vertices.size(), watch.Seconds());
  const MeshRays rays(surface.mesh);
  const LightTransport transport = TraceLight(surface.mesh, rays, arguments.fit.directions,
                                              static_cast<float>(1.5 * surface.distance.cell));
  fmt::print("shadows traced, {:.1f} s\n", watch.Seconds());
  std::vector<ObservedView> observed;
  for (const View& view : data.train) {
    observed.push_back({&view, view.camera, view.normalized_from_camera});
  }
  SurfaceObservations observations = ObserveSurface(observed, data.encoding, surface.mesh, rays);
  fmt::print("{} observations, {:.1f} s\n", observations.Size(), watch.Seconds());

  torch::Tensor known;
  if (arguments.is_light_known) {
    const nlohmann::json test =
        nlohmann::json::parse(std::ifstream(arguments.truth / "transforms_test.json"));
    const nlohmann::json& light = test["lights"]["E0"];
    const EnvironmentMap map =
        EnvironmentMap::Read(arguments.truth.parent_path() / "environments" / light["file"]);
    known =
        RadianceFrom(map, transport.directions, MapFromZUpWorld() * frame.rotation.transpose()) *
        light["png_exposure"].get<float>();
  }
  const auto field = std::make_shared<MaterialField>(
      Eigen::AlignedBox3d(
          surface.distance.origin,
          surface.distance.PositionOf(surface.distance.size.x() - 1, surface.distance.size.y() - 1,
                                      surface.distance.size.z() - 1)),
      2 * arguments.surface.resolution, 1);
  MaterialFit fit(std::move(observations), transport, field, arguments.fit, 1, known);
  double sum = 0;
  int summed = 0;
  for (int step = 1; step <= arguments.steps; ++step) {
    sum += fit.Step(static_cast<double>(step - 1) / arguments.steps);
    ++summed;
    if (step % std::max(1, arguments.steps / 4) != 0) continue;
    fmt::print("{} steps, {:.1f} s: {:.2f} dB\n", step, watch.Seconds(),
               -10 * std::log10(sum / summed));
    std::fflush(stdout);
    sum = summed = 0;
  }
  std::vector<TestView> views;
  for (const PosedImage& image : run.posed.images) {
    if (image.split != Split::kTest) continue;
    views.push_back(LookFrom(*run.model, surface, rays, image, run.posed.cameras[image.camera]));
  }
  CompareWithTruth(
      arguments.truth,
      {surface, transport, *field, arguments.fit.normal_offset, frame.rotation.transpose()},
      std::move(views));
  fmt::print("{:.1f} s in all, peak {:.0f} MB\n", watch.Seconds(), PeakMegabytes());
}

}  // namespace
}  // namespace nerf

int main(int argc, char** argv) { nerf::Run(argc, argv); }
