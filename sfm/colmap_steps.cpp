#include "sfm/colmap_steps.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>

#include "nerf/base/atomic_file.h"
#include "nerf/base/input_error.h"
#include "nerf/base/progress.h"
#include "nerf/base/text.h"
#include "sfm/colmap_database.h"
#include "sfm/colmap_model.h"

namespace nerf::sfm {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

// For captures in which the mapper finds no initial pair with its defaults (100, 16, 30, 15).
const std::vector<std::string> kRelaxedMapping = {
    "--Mapper.init_min_num_inliers",     "50", "--Mapper.init_min_tri_angle", "8",
    "--Mapper.abs_pose_min_num_inliers", "15", "--Mapper.min_num_matches",    "10"};

// The mapper spends most of its time on adjusting again what hardly moves any more. These bounds
// halve that time and change poses by less than their error (docs/benchmarks.md); a global
// adjustment still ends the mapping. Newer names of an option follow the older one.
struct MapperBound {
  std::vector<std::string> names;
  const char* value;
  const char* of_many =
      value;  // a global adjustment takes longer than in proportion to their number
};
constexpr int kManyPhotographs = 500;
const std::vector<MapperBound> kMapperBounds = {
    {{"Mapper.ba_global_images_ratio", "Mapper.ba_global_frames_ratio"}, "1.4", "2"},
    {{"Mapper.ba_global_points_ratio"}, "1.4", "2"},
    {{"Mapper.ba_global_max_refinements"}, "2", "1"},
    {{"Mapper.ba_global_max_num_iterations"}, "20"},
    {{"Mapper.ba_global_function_tolerance"}, "1e-6"},
    {{"Mapper.ba_local_max_refinements"}, "1"},
    {{"Mapper.ba_local_max_num_iterations"}, "10"},
    {{"Mapper.ba_local_function_tolerance"}, "1e-5"},
    {{"Mapper.ba_local_num_images"}, "4"},
    {{"Mapper.ba_min_num_residuals_for_multi_threading",
      "Mapper.ba_min_num_residuals_for_cpu_multi_threading"},
     "5000"},
};

// The steps remove old results, so the workspace must not contain other files.
fs::path OpenWorkspace(fs::path workspace) {
  workspace = fs::absolute(workspace).lexically_normal();
  MakeOutputFolder(workspace);
  if (!fs::exists(workspace / "steps.json") && !fs::is_empty(workspace)) {
    throw InputError(
        "{}: contains files that are not from an earlier run; give another output folder",
        workspace.string());
  }
  return workspace;
}

// The models that the mapper wrote: PARENT/0, PARENT/1, ...
std::vector<fs::path> ModelsIn(const fs::path& parent) {
  std::vector<fs::path> models;
  std::error_code error;
  for (fs::directory_iterator it(parent, error), end; !error && it != end; it.increment(error)) {
    if (IsColmapModel(it->path())) models.push_back(it->path());
  }
  return models;
}

json FilesAsInputs(const std::vector<PhotoFile>& files) {
  json list = json::array();
  for (const auto& [name, file] : files) {
    std::error_code error;
    const auto changed = fs::last_write_time(file, error).time_since_epoch().count();
    list.push_back({file.string(), fs::file_size(file, error), changed});
  }
  return list;
}

}  // namespace

ColmapSteps::ColmapSteps(fs::path workspace, const ColmapOptions& options, int photos)
    : colmap_(ColmapProgram::Find()),
      workspace_(OpenWorkspace(std::move(workspace))),
      options_(options),
      photos_(photos),
      ledger_(workspace_ / "steps.json") {}

void ColmapSteps::PrepareImages(const std::vector<PhotoFile>& files,
                                const std::vector<Photo>& photos,
                                const std::vector<ColmapImage>& plan) {
  for (const Photo& photo : photos) {
    longest_side_ = std::max({longest_side_, photo.width, photo.height});
  }
  Step("images", FilesAsInputs(files), Images(), [&](StepLedger::State) {
    RemoveAll(Images());
    WriteColmapImages(photos, plan, Images(), options_.threads,
                      colmap_.ResolvesLinks() ? PhotoLinks::kHard : PhotoLinks::kSymbolic);
  });
}

// -1: features are also extracted from the photograph enlarged by two, which takes four times as
// long. Small photographs have too few features otherwise.
int ColmapSteps::FirstOctave() const {
  constexpr int kSmall = 1200;
  const bool is_small = std::min(longest_side_, options_.max_image_size) < kSmall;
  return is_small || options_.enlarge ? -1 : 0;
}

void ColmapSteps::ExtractFeatures() {
  json inputs = {options_.camera_model, options_.max_image_size, options_.max_num_features};
  if (options_.enlarge) inputs.push_back("enlarged");
  Step("features", inputs, Database(), [&](StepLedger::State) {
    // Always from the beginning: COLMAP would create another camera for the photographs that an
    // interrupted run had not processed.
    RemoveDatabase(Database());
    Arguments arguments = {"--database_path",
                           Database().string(),
                           "--image_path",
                           Images().string(),
                           "--ImageReader.single_camera_per_folder",
                           "1",
                           "--ImageReader.camera_model",
                           options_.camera_model};
    const std::string command = "feature_extractor";
    AddKnown(command, {"SiftExtraction.use_gpu", "FeatureExtraction.use_gpu"}, "0", arguments);
    AddKnown(command, {"SiftExtraction.max_image_size", "FeatureExtraction.max_image_size"},
             std::to_string(options_.max_image_size), arguments);
    AddKnown(command, {"SiftExtraction.max_num_features"},
             std::to_string(options_.max_num_features), arguments);
    AddKnown(command, {"SiftExtraction.first_octave"}, std::to_string(FirstOctave()), arguments);
    AddThreads(command, {"SiftExtraction.num_threads", "FeatureExtraction.num_threads"}, arguments);
    RunOrThrow("features", command, arguments);
  });
}

void ColmapSteps::Map() {
  Step("mapper", json::object(), Sparse(), [&](StepLedger::State) {
    RemoveAll(Sparse());
    RunMapper("mapper", Sparse(), {});
  });
}

void ColmapSteps::MapRelaxed() { MapAgain("mapper_relaxed", kRelaxedMapping); }

void ColmapSteps::MapAgain(const std::string& step, const Arguments& thresholds) {
  Step(step, json::object(), Sparse(), [&](StepLedger::State) {
    const fs::path attempt = workspace_ / "sparse_again";
    RemoveAll(attempt);
    RunMapper(step, attempt, thresholds);
    int number = 0;
    for (const fs::path& model : ModelsIn(attempt)) {
      while (fs::exists(Sparse() / std::to_string(number))) ++number;
      fs::rename(model, Sparse() / std::to_string(number));
    }
    RemoveAll(attempt);
  });
}

std::vector<fs::path> ColmapSteps::Models() const {
  std::vector<std::pair<int, fs::path>> counted;
  for (const fs::path& model : ModelsIn(Sparse())) {
    counted.emplace_back(-CountRegistered(model), model);
  }
  std::ranges::sort(counted);
  std::vector<fs::path> models;
  for (const auto& [count, model] : counted) models.push_back(model);
  return models;
}

PosedImages ColmapSteps::ReadModel(const fs::path& model) const {
  return ReadColmapModel(model, Images());
}

fs::path ColmapSteps::LogFile(const std::string& step) const {
  return workspace_ / "log" / (step + ".log");
}

void ColmapSteps::Step(const std::string& name, const json& inputs, const fs::path& result,
                       const std::function<void(StepLedger::State)>& work) {
  const StepLedger::State state = ledger_.StateOf(name, inputs);
  if (state == StepLedger::State::kDone && fs::exists(result)) {
    spdlog::info("{}: done already, skipped", name);
  } else {
    spdlog::info("{}: {} photographs ...", name, photos_);
    ledger_.Begin(name, inputs);
    const auto begin = std::chrono::steady_clock::now();
    work(state);
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
    ledger_.Finish(name, elapsed.count());
  }
  seconds_.emplace_back(name, ledger_.Seconds(name));
}

void ColmapSteps::AddKnown(const std::string& command, const std::vector<std::string>& names,
                           const std::string& value, Arguments& arguments) {
  const std::string option = colmap_.KnownOption(command, names);
  if (option.empty()) return;
  arguments.push_back("--" + option);
  arguments.push_back(value);
}

void ColmapSteps::AddThreads(const std::string& command, const std::vector<std::string>& names,
                             Arguments& arguments) {
  if (options_.threads > 0) {
    AddKnown(command, names, std::to_string(options_.threads), arguments);
  }
}

ColmapProgram::Outcome ColmapSteps::Run(const std::string& step, const std::string& command,
                                        const Arguments& arguments) const {
  MakeOutputFolder(LogFile(step).parent_path());
  ProgressLine line(step, photos_);
  int total = photos_;
  return colmap_.Run(command, arguments, LogFile(step), [&](std::string_view output) {
    const StepProgress progress = ParseProgress(output);
    if (progress.done == 0) return;
    if (progress.total > 0) total = progress.total;
    line.Update(static_cast<std::int64_t>(progress.done) * photos_ / total);
  });
}

void ColmapSteps::RunOrThrow(const std::string& step, const std::string& command,
                             const Arguments& arguments) const {
  const ColmapProgram::Outcome outcome = Run(step, command, arguments);
  if (outcome.exit_code != 0) ThrowStepFailed(command, outcome, LogFile(step));
}

// Finding no model is not an error here: the number of registered photographs decides what follows.
void ColmapSteps::RunMapper(const std::string& step, const fs::path& target,
                            const Arguments& thresholds) {
  MakeOutputFolder(target);
  Arguments arguments = {"--database_path", Database().string(), "--image_path",
                         Images().string(), "--output_path",     target.string()};
  arguments.insert(arguments.end(), thresholds.begin(), thresholds.end());
  for (const MapperBound& bound : kMapperBounds) {
    AddKnown("mapper", bound.names, photos_ > kManyPhotographs ? bound.of_many : bound.value,
             arguments);
  }
  AddThreads("mapper", {"Mapper.num_threads"}, arguments);
  const ColmapProgram::Outcome outcome = Run(step, "mapper", arguments);
  const bool found_nothing =
      Lowercase(outcome.last_line).find("failed to create") != std::string::npos ||
      outcome.last_line.find("No good initial image pair") != std::string::npos;
  if (outcome.exit_code != 0 && !found_nothing) ThrowStepFailed("mapper", outcome, LogFile(step));
}

}  // namespace nerf::sfm
