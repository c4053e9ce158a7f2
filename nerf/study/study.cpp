#include "nerf/study/study.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <fstream>
#include <utility>

#include "nerf/base/atomic_file.h"
#include "nerf/base/input_error.h"
#include "nerf/base/parallel.h"
#include "nerf/base/peak_memory.h"
#include "nerf/base/processor_name.h"
#include "nerf/base/stopwatch.h"
#include "nerf/image/image_io.h"
#include "nerf/model/evaluation.h"
#include "nerf/model/refined_poses.h"
#include "nerf/model/run_folder.h"
#include "nerf/pipeline/effect_decisions.h"
#include "nerf/pipeline/representation_training.h"
#include "nerf/render/non_finite_error.h"
#include "nerf/study/crop.h"
#include "nerf/study/pareto.h"
#include "sfm/transforms_json.h"

namespace nerf {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr double kQualities[] = {1, 0.75, 0.5, 0.25, 0};
constexpr double kExact[] = {1};  // Gaussians have no other

constexpr double kSlowestFrame = 5;  // seconds; above it only quality 1 is measured

// Seconds of a setting beside its training, assumed until the first one is measured.
constexpr double kFirstOverhead = 4;

// Share of the budget of a setting of middle length, for which effects are decided.
constexpr double kMiddleShare = 0.07;

fs::path JsonPath(const fs::path& folder) { return folder / "study.json"; }

// The total time of each stage, the validation curve and the peak memory from metrics.jsonl.
json CostsOf(const fs::path& metrics) {
  json stages = json::object(), curve = json::array();
  double peak = 0;
  std::ifstream file(metrics);
  for (std::string line; std::getline(file, line);) {
    const json of_line = json::parse(line);
    for (const auto& [stage, seconds] : of_line.at("stage_seconds").items()) {
      stages[stage] = stages.value(stage, 0.0) + seconds.get<double>();
    }
    if (of_line.contains("validation_psnr")) {
      curve.push_back({of_line.at("seconds"), of_line.at("validation_psnr")});
    }
    peak = of_line.at("peak_megabytes");
  }
  return {{"stage_seconds", stages}, {"validation_curve", curve}, {"peak_megabytes", peak}};
}

// What is not finite is on no front; JSON has null for it.
double NumberOf(const json& value) {
  return value.is_number() ? value.get<double>() : std::nan("");
}

}  // namespace

Study::Study(PreparedScene scene, const StudyOptions& options, fs::path folder,
             PipelineListener listener)
    : scene_(std::move(scene)),
      options_(options),
      folder_(std::move(folder)),
      listener_(std::move(listener)),
      settings_(StudySettings(options.downscale)) {
  std::vector<std::size_t> all;
  for (std::size_t i = 0; i < scene_.posed.images.size(); ++i) {
    if (scene_.posed.images[i].split == Split::kTest) all.push_back(i);
  }
  const std::string source = scene_.posed.source.string();
  if (all.empty()) {
    throw InputError("{}: a study needs held-out photographs; use at least 8 photographs", source);
  }
  const auto count = std::min(all.size(), options_.held_out);
  json names = json::array();
  for (std::size_t i = 0; i < count; ++i) {
    held_out_.push_back(all[i * all.size() / count]);
    names.push_back(scene_.posed.images[held_out_.back()].name);
  }
  results_ = {{"input", source},
              {"processor", ProcessorName()},
              {"threads", NumThreads()},
              {"downscale", options_.downscale},
              {"budget_seconds", options_.budget},
              {"held_out", names},
              {"spent_seconds", 0.0},
              {"settings", json::array()}};
  if (fs::exists(JsonPath(folder_))) ReadEarlierResults();
}

void Study::ReadEarlierResults() {
  const json before =
      json::parse(ReadWholeFile(JsonPath(folder_)), nullptr, /*allow_exceptions=*/false);
  for (const char* key : {"input", "downscale", "budget_seconds", "held_out"}) {
    if (!before.is_object() || !before.contains(key) || before[key] != results_[key]) {
      throw InputError("{}: belongs to another study ({} differs); choose another folder with -o",
                       JsonPath(folder_).string(), key);
    }
  }
  if (!before.contains("effects") && !before.value("settings", json::array()).empty()) {
    throw InputError(
        "{}: is of an earlier version, which did not decide effects; choose another folder with -o",
        JsonPath(folder_).string());
  }
  const json settings = before.value("settings", json::array());
  for (std::size_t i = 0; i < settings.size(); ++i) {
    if (i >= settings_.size() || settings[i].value("name", "") != settings_[i].name) {
      throw InputError("{}: is of a version with other settings; choose another folder with -o",
                       JsonPath(folder_).string());
    }
  }
  results_ = before;
  decided_ = results_.value("effects", std::vector<std::string>());
}

// Reads each resolution once.
Study::Photographs& Study::Read(const Config& config) {
  const auto [found, is_new] = photographs_.try_emplace(config.data.downscale);
  Photographs& photographs = found->second;
  if (!is_new) return photographs;
  const Stopwatch watch;
  Config without_depth = config;  // whose points are in the folder of a run
  without_depth.effects.depth_supervision.reset();
  photographs.data =
      LoadPhotographs(scene_.posed, without_depth, scene_.normalized_from_world, {}, listener_);
  AddSparseDepths(scene_.posed, scene_.normalized_from_world, photographs.data);
  photographs.facts = FactsOf(photographs.data, scene_.normalized_from_world);
  photographs.facts.exposure_stops = scene_.StopsOf(photographs.data.train);
  photographs.seconds = watch.Seconds();
  return photographs;
}

// Decides effects as `nerf train` does, once for all settings.
void Study::DecideEffects() {
  EffectDecisions decisions(scene_.inspection, {});
  decided_ = decisions.Assignments();
  const double seconds = std::max(1.0, kMiddleShare * options_.budget);
  const StudySetting balanced = {"effects", "balanced", {}, 1};
  Photographs& photographs = Read(ConfigOf(balanced, seconds));
  if (photographs.facts.has_alpha) decisions.DisableBackgroundForAlpha(listener_);
  decided_ = decisions.Assignments();
  decisions.RunTrials(ConfigOf(balanced, seconds), photographs.facts, seconds, photographs.data,
                      listener_);
  decided_ = decisions.Assignments();
  results_["effects"] = decided_;
}

Config Study::ConfigOf(const StudySetting& setting, double seconds) const {
  std::vector<std::string> assignments = {fmt::format("data.downscale={}", options_.downscale),
                                          fmt::format("train.time_budget={:.3f}", seconds),
                                          "train.representation=field"};
  assignments.insert(assignments.end(), decided_.begin(), decided_.end());
  assignments.insert(assignments.end(), setting.assignments.begin(), setting.assignments.end());
  return LoadConfig(setting.preset, assignments);
}

// The value of the key "qualities" of a setting: PSNR, SSIM and seconds per frame at each of them.
// Also writes the setting's crop.
json Study::EvaluateQualities(const SceneModel& model, std::span<const double> qualities,
                              const PosedImages& posed, const std::string& name) {
  std::vector<const PosedImage*> images;
  for (const std::size_t i : held_out_) images.push_back(&posed.images[i]);
  json measured = json::array();
  for (const double quality : qualities) {
    // A barely trained field can take minutes per frame.
    if (quality < 1 && measured[0]["seconds_per_frame"] > kSlowestFrame) break;
    const Evaluation evaluation = Evaluate(
        model, posed, images, {quality, false, options_.downscale}, [&](const EvaluatedView& view) {
          if (quality != 1 || view.image != images.front()) return;
          const Patch patch = MostDetailedPatch(*view.truth);
          MakeOutputFolder(folder_ / "crops");
          WriteImage(folder_ / "crops" / (name + ".png"), Crop(*view.rendering, patch));
          WriteImage(folder_ / "crops" / "truth.png", Crop(*view.truth, patch));
        });
    for (const std::string& reason : evaluation.unreadable) {
      if (reported_.insert(reason).second) listener_(Warning{reason});
    }
    if (evaluation.scores.empty()) throw InputError("{}", evaluation.unreadable.front());
    const ViewScore mean = evaluation.Mean();
    measured.push_back({{"quality", quality},
                        {"psnr", mean.psnr},
                        {"ssim", mean.ssim},
                        {"seconds_per_frame", mean.seconds}});
  }
  return measured;
}

json Study::Measure(const StudySetting& setting, double seconds, const std::atomic<bool>& stop) {
  const Config config = ConfigOf(setting, seconds);
  const fs::path run = folder_ / "runs" / setting.name;
  RemoveAll(run);
  MakeOutputFolder(run);
  WriteFileAtomically(ConfigPath(run), JsonFromConfig(config).dump(2) + "\n");
  sfm::WriteTransformsJson(scene_.posed, PosesPath(run));
  SaveSparsePoints(scene_.posed, config, run);
  const Photographs& photographs = Read(config);
  const Stopwatch watch;
  Trainer trainer(config, photographs.facts, photographs.data, run);
  RepresentationsTrained trained;
  std::string why_not;
  try {
    trained = TrainRepresentations(trainer, photographs.data, run, stop, listener_);
    if (!trained.finished) return {};
  } catch (const InputError& error) {  // no Gaussians of such photographs, or of such a field
    if (config.train.representation != Representation::kSplats) throw;
    why_not = error.what();
  } catch (const NonFiniteError& error) {
    if (config.train.representation != Representation::kSplats) throw;
    why_not = error.what();
  }
  json result = CostsOf(MetricsPath(run));
  result["name"] = setting.name;
  result["preset"] = setting.preset;
  result["assignments"] = setting.assignments;
  result["seconds"] = photographs.seconds + watch.Seconds();
  result["steps"] = trainer.Steps();
  result["peak_megabytes"] = PeakMegabytes();
  if (!why_not.empty()) {
    listener_(Warning{fmt::format("{}: {}", setting.name, why_not)});
    result["left_out"] = why_not;
    result["qualities"] = json::array();
    return result;
  }
  const PosedImages posed = RefinedPoses(trainer.GetModel(), scene_.posed);
  if (config.train.representation == Representation::kSplats) {
    const auto model = OpenGaussians(run);
    result["gaussians"] = model->Cloud().count;
    result["stage_seconds"]["gaussians"] = model->Made().seconds;
    result["qualities"] = EvaluateQualities(*model, kExact, posed, setting.name);
  } else {
    const auto model = ModelSnapshot::Copy(trainer.GetModel(), trainer.Steps());
    result["qualities"] = EvaluateQualities(*model, kQualities, posed, setting.name);
  }
  return result;
}

// Sets "on_training_front" of each setting, and "on_rendering_front" of each of its qualities.
void Study::MarkFronts() {
  std::vector<CostAndValue> trainings, renderings;
  std::vector<json*> qualities;
  for (json& setting : results_["settings"]) {
    // One that was left out has none.
    const json psnr = setting["qualities"].empty() ? json() : setting["qualities"][0]["psnr"];
    trainings.push_back({setting["seconds"], NumberOf(psnr)});
    setting["on_training_front"] = false;
    for (json& quality : setting["qualities"]) {
      renderings.push_back({quality["seconds_per_frame"], NumberOf(quality["psnr"])});
      quality["on_rendering_front"] = false;
      qualities.push_back(&quality);
    }
  }
  for (const std::size_t i : ParetoFront(trainings)) {
    results_["settings"][i]["on_training_front"] = true;
  }
  for (const std::size_t i : ParetoFront(renderings)) (*qualities[i])["on_rendering_front"] = true;
}

void Study::Save() const {
  // File names may not be valid UTF-8.
  WriteFileAtomically(JsonPath(folder_),
                      results_.dump(2, ' ', false, json::error_handler_t::replace) + "\n");
}

bool Study::Run(const std::atomic<bool>& stop,
                const std::function<void(std::size_t, const StudySetting&, double)>& on_begin) {
  const double spent_before = results_["spent_seconds"];
  const Stopwatch watch;
  if (!results_.contains("effects")) {
    DecideEffects();
    Save();
  }
  double overhead = kFirstOverhead;
  for (std::size_t next = results_["settings"].size(); next < settings_.size(); ++next) {
    const double left = options_.budget - spent_before - watch.Seconds();
    const double seconds = SecondsOfSetting(settings_, next, left, overhead);
    on_begin(next, settings_[next], seconds);
    const Stopwatch setting_watch;
    const json result = Measure(settings_[next], seconds, stop);
    if (result.is_null()) return false;
    overhead = std::max(0.0, setting_watch.Seconds() - seconds);
    results_["settings"].push_back(result);
    results_["spent_seconds"] = spent_before + watch.Seconds();
    MarkFronts();
    Save();
  }
  return true;
}

}  // namespace nerf
