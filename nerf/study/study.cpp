#include "nerf/study/study.h"

#include <algorithm>
#include <fstream>

#include "nerf/base/atomic_file.h"
#include "nerf/base/input_error.h"
#include "nerf/base/parallel.h"
#include "nerf/base/processor_name.h"
#include "nerf/base/stopwatch.h"
#include "nerf/config/config.h"
#include "nerf/image/image_convert.h"
#include "nerf/image/image_io.h"
#include "nerf/image/image_metrics.h"
#include "nerf/model/run_folder.h"
#include "nerf/model/view_renderer.h"
#include "nerf/render/image_renderer.h"
#include "nerf/scene/camera.h"
#include "nerf/scene/dataset.h"
#include "nerf/scene/photograph.h"
#include "nerf/scene/scene_normalization.h"
#include "nerf/scene/splits.h"
#include "nerf/study/crop.h"
#include "nerf/study/pareto.h"
#include "nerf/train/trainer.h"
#include "sfm/transforms_json.h"

namespace nerf {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr double kDial[] = {1, 0.75, 0.5, 0.25, 0};

constexpr double kSlowestFrame = 5;  // seconds, of which all positions of the dial are measured

// What a setting takes beside its training, until the first has told.
constexpr double kFirstOverhead = 4;  // seconds

fs::path JsonPath(const fs::path& folder) { return folder / "study.json"; }

// Of the stages of all lines of metrics.jsonl, and the curve of validation.
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

}  // namespace

Study::Study(PosedImages posed, const StudyOptions& options, fs::path folder)
    : posed_(std::move(posed)),
      options_(options),
      folder_(std::move(folder)),
      settings_(StudySettings(options.downscale)),
      normalized_from_world_(NormalizeScene(posed_)) {
  AssignSplits(posed_, LoadConfig("balanced", {}).data);
  std::vector<const PosedImage*> all;
  for (const auto& image : posed_.images) {
    if (image.split == Split::kTest) all.push_back(&image);
  }
  if (all.empty()) {
    throw InputError("{}: a study is measured on held-out photographs; take 8 at least",
                     posed_.source.string());
  }
  const auto count = std::min(all.size(), options_.held_out);
  for (std::size_t i = 0; i < count; ++i) held_out_.push_back(all[i * all.size() / count]);

  json names = json::array();
  for (const auto* image : held_out_) names.push_back(image->name);
  results_ = {{"input", posed_.source.string()},
              {"processor", ProcessorName()},
              {"threads", NumThreads()},
              {"downscale", options_.downscale},
              {"budget_seconds", options_.budget},
              {"held_out", names},
              {"spent_seconds", 0.0},
              {"settings", json::array()}};
  if (!fs::exists(JsonPath(folder_))) return;
  const json before =
      json::parse(ReadWholeFile(JsonPath(folder_)), nullptr, /*allow_exceptions=*/false);
  for (const char* key : {"input", "downscale", "budget_seconds", "held_out"}) {
    if (!before.is_object() || !before.contains(key) || before[key] != results_[key]) {
      throw InputError("{}: is of another study ({} differs); choose another folder with -o",
                       JsonPath(folder_).string(), key);
    }
  }
  results_ = before;
}

// Each resolution is read once.
const Study::Photographs& Study::Read(const Config& config) {
  const auto [found, is_new] = photographs_.try_emplace(config.data.downscale);
  if (is_new) {
    const Stopwatch watch;
    found->second.data =
        LoadDataset(posed_, config.data, MeaningOf(config.effects.masks), normalized_from_world_);
    found->second.seconds = watch.Seconds();
  }
  return found->second;
}

json Study::Measure(const StudySetting& setting, double seconds, const std::atomic<bool>& stop) {
  std::vector<std::string> assignments = {fmt::format("data.downscale={}", options_.downscale),
                                          fmt::format("train.time_budget={:.3f}", seconds)};
  assignments.insert(assignments.end(), setting.assignments.begin(), setting.assignments.end());
  const Config config = LoadConfig(setting.preset, assignments);

  const fs::path run = folder_ / "runs" / setting.name;
  RemoveAll(run);
  MakeOutputFolder(run);
  WriteFileAtomically(ConfigPath(run), JsonFromConfig(config).dump(2) + "\n");
  sfm::WriteTransformsJson(posed_, PosesPath(run));
  const Photographs& photographs = Read(config);
  const SceneFacts scene = FactsOf(photographs.data, normalized_from_world_);
  const Stopwatch watch;
  Trainer trainer(config, scene, photographs.data, run);
  const TrainSummary summary = trainer.Run(stop);
  if (!summary.finished) return {};

  json result = CostsOf(MetricsPath(run));
  result["name"] = setting.name;
  result["preset"] = setting.preset;
  result["assignments"] = setting.assignments;
  result["seconds"] = photographs.seconds + watch.Seconds();
  result["steps"] = summary.step;
  result["dial"] = json::array();
  for (const double quality : kDial) {
    // A field that is hardly trained can take minutes a frame: one position says so.
    if (quality < 1 && result["dial"][0]["seconds_per_frame"] > kSlowestFrame) break;
    const auto renderer = ViewRenderer(trainer.GetModel(), quality);
    double psnr = 0, ssim = 0, frame = 0;
    for (const PosedImage* image : held_out_) {
      const Image truth = OnWhite(
          LoadPhotograph(posed_, *image, {options_.downscale, MeaningOf(config.effects.masks)})
              .pixels);
      const Stopwatch of_frame;
      const RenderedView view =
          RenderView(*renderer, Downscaled(posed_.cameras[image->camera], options_.downscale),
                     scene.normalized_from_world.NormalizedFromCamera(image->world_from_camera),
                     DisplayBackground(scene.has_alpha), scene.encoding);
      const double part = 1.0 / static_cast<double>(held_out_.size());
      frame += part * of_frame.Seconds();
      psnr += part * Psnr(truth, view.rgb);
      ssim += part * Ssim(truth, view.rgb);
      if (quality == 1 && image == held_out_.front()) {
        const Patch patch = BusiestPatch(truth);
        MakeOutputFolder(folder_ / "crops");
        WriteImage(folder_ / "crops" / (setting.name + ".png"), Crop(view.rgb, patch));
        WriteImage(folder_ / "crops" / "truth.png", Crop(truth, patch));
      }
    }
    result["dial"].push_back(
        {{"quality", quality}, {"psnr", psnr}, {"ssim", ssim}, {"seconds_per_frame", frame}});
  }
  return result;
}

// "on_training_front" of each setting, and "on_rendering_front" of each position of its dial.
void Study::MarkFronts() {
  std::vector<Offer> trainings, renderings;
  std::vector<json*> positions;
  for (json& setting : results_["settings"]) {
    trainings.push_back({setting["seconds"], setting["dial"][0]["psnr"]});
    setting["on_training_front"] = false;
    for (json& position : setting["dial"]) {
      renderings.push_back({position["seconds_per_frame"], position["psnr"]});
      position["on_rendering_front"] = false;
      positions.push_back(&position);
    }
  }
  for (const std::size_t i : ParetoFront(trainings)) {
    results_["settings"][i]["on_training_front"] = true;
  }
  for (const std::size_t i : ParetoFront(renderings)) (*positions[i])["on_rendering_front"] = true;
}

void Study::Save() const {
  // Names of files need not be UTF-8.
  WriteFileAtomically(JsonPath(folder_),
                      results_.dump(2, ' ', false, json::error_handler_t::replace) + "\n");
}

bool Study::Run(const std::atomic<bool>& stop,
                const std::function<void(std::size_t, const StudySetting&, double)>& begins) {
  const double spent_before = results_["spent_seconds"];
  const Stopwatch watch;
  double overhead = kFirstOverhead;
  for (std::size_t next = results_["settings"].size(); next < settings_.size(); ++next) {
    const double left = options_.budget - spent_before - watch.Seconds();
    const double seconds = SecondsOfSetting(settings_, next, left, overhead);
    begins(next, settings_[next], seconds);
    const Stopwatch of_setting;
    const json result = Measure(settings_[next], seconds, stop);
    if (result.is_null()) return false;
    overhead = std::max(0.0, of_setting.Seconds() - seconds);
    results_["settings"].push_back(result);
    results_["spent_seconds"] = spent_before + watch.Seconds();
    MarkFronts();
    Save();
  }
  return true;
}

}  // namespace nerf
