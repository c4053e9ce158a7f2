#include "nerf/pipeline/training_session.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <utility>

#include "nerf/base/atomic_file.h"
#include "nerf/base/input_error.h"
#include "nerf/base/parallel.h"
#include "nerf/base/progress.h"
#include "nerf/base/temporary_file.h"
#include "nerf/effects/depth_supervision.h"
#include "nerf/image/image_files.h"
#include "nerf/model/checkpoint.h"
#include "nerf/model/refined_poses.h"
#include "nerf/model/run_folder.h"
#include "nerf/pipeline/budget_plan.h"
#include "nerf/pipeline/material_training.h"
#include "nerf/pipeline/representation_training.h"
#include "nerf/pipeline/training_materials.h"
#include "nerf/pipeline/training_picture.h"
#include "nerf/pipeline/training_resolution.h"
#include "sfm/colmap_estimate.h"
#include "sfm/film.h"
#include "sfm/photo_folder.h"
#include "sfm/pose_input.h"
#include "sfm/transforms_json.h"

namespace nerf {

namespace fs = std::filesystem;

// For the picture at the end, beside what the trainer itself reserves.
constexpr double kPictureSeconds = 0.4;

TrainingSession::TrainingSession(TrainingRequest request, const Stopwatch& watch,
                                 PipelineListener listener)
    : request_(std::move(request)), watch_(watch), listener_(std::move(listener)) {
  const std::vector<std::string> effects = request_.effects.Assignments();
  request_.assignments.insert(request_.assignments.end(), effects.begin(), effects.end());
}

Config TrainingSession::ConfigWithDecisions(const std::string& preset) const {
  std::vector<std::string> all = request_.assignments;
  all.insert(all.end(), decisions_.Assignments().begin(), decisions_.Assignments().end());
  return LoadConfig(preset, all);
}

void TrainingSession::WriteConfig() const {
  WriteFileAtomically(ConfigPath(request_.run), JsonFromConfig(config_).dump(2) + "\n");
}

// A folder belongs to a run once it contains config.json. Before that, an existing transforms.json
// may be the input and must not be overwritten.
void TrainingSession::CheckRunFolder() const {
  const fs::path& run = request_.run;
  if (fs::exists(CheckpointPath(run))) {
    throw InputError(
        "{}: already contains a run; use --resume to continue it, or choose another folder with -o",
        run.string());
  }
  for (const fs::path& file : {PosesPath(run), MetricsPath(run), LightsPath(run)}) {
    if (!fs::exists(file) || fs::exists(ConfigPath(run))) continue;
    throw InputError(
        "{}: already exists and was not written by nerf train; choose another folder with -o",
        file.string());
  }
}

// A target PSNR needs validation photographs.
void TrainingSession::RequireValidation() const {
  const auto validates = [](const auto& image) { return image.split == Split::kValidation; };
  if (config_.train.target_psnr == 0) return;
  if (std::ranges::any_of(scene_.posed.images, validates)) return;
  throw InputError(
      "train.target_psnr needs validation photographs, and there are none: set "
      "data.validation_images to 1 or more, and use at least 16 photographs");
}

// Seconds of the time budget that are spent. The time for finding poses cannot be bounded, so
// training gets at least half of the budget.
double TrainingSession::SpentSeconds() const {
  const double budget = config_.train.time_budget;
  if (budget == 0) return watch_.Seconds();
  return std::min(watch_.Seconds() + kPictureSeconds, RadianceSeconds(config_) / 2);
}

// For photographs and films whose poses are not found yet.
void TrainingSession::EstimateWait() const {
  const sfm::InputLocation input = sfm::FindInput(request_.input);
  if (fs::exists(ColmapPath(request_.run))) return;
  WaitEstimated wait;
  wait.training_seconds = TrainingSeconds(config_.train);
  sfm::ColmapOptions colmap;
  int longest_side = 0;
  if (input.kind == sfm::InputKind::kPhotos) {
    const std::vector<sfm::PhotoFile> files = sfm::ListPhotos(input.images);
    wait.photographs = static_cast<int>(files.size());
    if (const auto size = ReadImageSize(files.front().path)) {
      longest_side = std::max(size->width, size->height);
    }
  } else if (input.kind == sfm::InputKind::kFilm) {
    const sfm::FilmPlan film = sfm::PlanFrames(input.images, config_.data.film_frames);
    wait.photographs = film.frames;
    wait.film_seconds = film.seconds;
    longest_side = film.longest_side;
    colmap.matcher = "sequential";
  }
  if (longest_side == 0) return;
  wait.pose_seconds =
      sfm::EstimatePoseSeconds(wait.photographs, longest_side, colmap, NumThreads());
  listener_(wait);
}

// Poses that are given are for pixels of a size that somebody chose; photographs have that of a
// camera.
void TrainingSession::ChooseResolution() {
  if (!scene_.from_photographs ||
      GivesKey(request_.preset, request_.assignments, "/data/downscale")) {
    return;
  }
  const auto size = [](const Camera& camera) { return std::max(camera.width, camera.height); };
  const Camera& largest = *std::ranges::max_element(scene_.posed.cameras, {}, size);
  const int downscale = DownscaleFor(size(largest), TrainingSeconds(config_.train));
  if (downscale == 1) return;
  request_.assignments.push_back(fmt::format("data.downscale={}", downscale));
  config_ = ConfigWithDecisions(request_.preset);
  listener_(ResolutionChosen{downscale, largest.width, largest.height});
}

void TrainingSession::PrepareCapture() {
  config_ = ConfigWithDecisions(request_.preset);
  CheckRunFolder();
  if (!request_.lights.empty()) ReadLightPlan(request_.lights);  // errors before poses are found
  EstimateWait();  // fails before a run folder is created
  scene_ = PrepareScene(request_.input, request_.run, config_.data, listener_);
  RequireValidation();
  ChooseResolution();
  if (request_.effects.inspect || config_.effects.depth_supervision) {
    AddMissingPoints(scene_, request_.run, PointSeconds(config_), listener_);
  }
  if (request_.effects.inspect) {
    const auto requested = NamedEffects(request_.preset, request_.assignments);
    InspectScene(config_, requested, scene_, listener_);
    decisions_ = EffectDecisions(scene_.inspection, requested);
    config_ = ConfigWithDecisions(request_.preset);
  }
  MakeOutputFolder(request_.run);
  if (config_.materials) PrepareLights(request_.lights, scene_, request_.run);
  SaveSparsePoints(scene_.posed, config_, request_.run);
  if (request_.effects.inspect) {
    listener_(
        CaptureInspected{&scene_.inspection, decisions_.Requested(), scene_.inspection_seconds});
  }
  WriteConfig();  // first, because it marks the folder as a run folder
  RemoveAll(RepresentationPath(request_.run));  // of a run that was never saved
  RemoveAll(GaussiansPath(request_.run));
  RemoveAll(MaterialsPath(request_.run));
  sfm::WriteTransformsJson(scene_.posed, PosesPath(request_.run));
  // Read back, so that a resumed run has the same poses bit for bit.
  posed_ = sfm::ReadTransformsJson(PosesPath(request_.run));
}

void TrainingSession::ReadPhotographs() {
  ReportDataPlan(posed_, config_.data, NumThreads(), listener_);
  data_ = LoadPhotographs(posed_, config_, scene_.normalized_from_world, request_.run, listener_);
  facts_ = FactsOf(data_, scene_.normalized_from_world);
}

void TrainingSession::DecideEffects() {
  if (!request_.effects.inspect) return;
  facts_.exposure_stops = scene_.StopsOf(data_.train);
  if (facts_.has_alpha) decisions_.DisableBackgroundForAlpha(listener_);
  config_ = ConfigWithDecisions(request_.preset);
  const bool tries_depth = decisions_.ShouldTry(kDepthSupervisionEffect);
  if (tries_depth) AddSparseDepths(scene_.posed, scene_.normalized_from_world, data_);
  decisions_.RunTrials(config_, facts_, config_.train.time_budget - watch_.Seconds(), data_,
                       listener_);
  config_ = ConfigWithDecisions(request_.preset);
  WriteConfig();
  WriteFileAtomically(request_.run / "effects.json",
                      decisions_.Report(config_, scene_.inspection_seconds).dump(2) + "\n");
  if (tries_depth && config_.effects.depth_supervision) {
    // Read back, as a resumed run reads them.
    SaveSparsePoints(scene_.posed, config_, request_.run);
    AddSavedSparsePoints(posed_, scene_.normalized_from_world, request_.run, data_);
  }
}

void TrainingSession::PlanTimeBudget() {
  if (config_.materials) {
    RequireOneExposure(config_);
    RequireOneEncoding(data_);
  }
  const double spent = SpentSeconds(), budget = config_.train.time_budget;
  if (budget > 0 && spent == RadianceSeconds(config_) / 2) {
    listener_(Warning{
        fmt::format("{} of the time budget were spent before training; training still gets {}",
                    FormatSeconds(watch_.Seconds()), FormatSeconds(RadianceSeconds(config_) / 2))});
  }
  trainer_ = std::make_unique<Trainer>(config_, facts_, data_, request_.run, spent);
  if (budget == 0 || request_.preset_is_given) return;
  // Where a trial may give the rest of the time to Gaussians, the preset is for the field's part.
  const bool has_splats = config_.train.representation != Representation::kField &&
                          WhyNoGaussians(config_, data_).empty();
  const double share = has_splats ? 1 - config_.splats.share : 1;
  const double seconds = share * (RadianceSeconds(config_) - spent);
  const BudgetPlan plan = PlanBudget(*trainer_, seconds);
  listener_(BudgetPlanned{budget, seconds, plan.preset, plan.steps});
  if (plan.preset == request_.preset) return;
  config_ = ConfigWithDecisions(plan.preset);
  WriteConfig();
  trainer_ = std::make_unique<Trainer>(config_, facts_, data_, request_.run, SpentSeconds());
}

TrainSummary TrainingSession::Train(const std::atomic<bool>& stop) {
  listener_(TrainingBegan{config_.train, trainer_->Snapshots()});
  const RepresentationsTrained trained =
      TrainRepresentations(*trainer_, data_, request_.run, stop, listener_);
  ReportRefinedPoses();
  std::optional<fs::path> picture;
  if (trained.finished) picture = WritePicture(trained.record.Best());
  TrainSummary summary = trained.field;
  summary.finished = trained.finished &&
                     (!config_.materials || MaterialsAfterTraining(*trainer_, posed_, data_,
                                                                   request_.run, stop, listener_));
  summary.reached_target = trained.reached_target;
  listener_(TrainingEnded{summary, config_.train, request_.run, picture});
  return summary;
}

std::optional<fs::path> TrainingSession::WritePicture(Representation best) const {
  constexpr double kFieldQuality = 0.5;  // of rendering
  const Model& field = trainer_->GetModel();
  const PosedImages refined = RefinedPoses(field, posed_);
  if (best == Representation::kSplats) {
    return WriteTrainingPicture(*OpenGaussians(request_.run), 1, refined, request_.run);
  }
  return WriteTrainingPicture(*ModelSnapshot::Copy(field, 0), kFieldQuality, refined, request_.run);
}

TrainSummary TrainingSession::Run(const std::atomic<bool>& stop) {
  if (!trainer_) {
    PrepareCapture();
    ReadPhotographs();
    DecideEffects();
    PlanTimeBudget();
  }
  return Train(stop);
}

// With pose refinement: reports its size, and writes RUN/refined_transforms.json.
void TrainingSession::ReportRefinedPoses() const {
  const Model& model = trainer_->GetModel();
  if (!model.pose_refinement) return;
  const SceneNormalization& normalized_from_world = model.scene.normalized_from_world;
  PoseRefinementSummary summary = Summarize(*model.pose_refinement);
  summary.median_shift = normalized_from_world.LengthWorldFromNormalized(summary.median_shift);
  summary.max_shift = normalized_from_world.LengthWorldFromNormalized(summary.max_shift);
  listener_(PosesRefined{summary});
  sfm::WriteTransformsJson(RefinedPoses(model, posed_), RefinedPosesPath(request_.run));
}

std::unique_ptr<TrainingSession> TrainingSession::Resume(const fs::path& run,
                                                         const Stopwatch& watch,
                                                         PipelineListener listener) {
  TrainingRequest request;
  request.run = run;
  auto session = std::make_unique<TrainingSession>(std::move(request), watch, std::move(listener));
  TrainingSession& s = *session;
  const Checkpoint checkpoint = ReadRunCheckpoint(run);
  RemoveAbandonedFiles(run);
  const Model model = ModelFromCheckpoint(checkpoint);
  const int threads = NumThreads();
  if (const int before = checkpoint.meta.value("threads", threads); before != threads) {
    s.listener_(Warning{fmt::format(
        "the run used {} threads and continues with {}; rounding will differ", before, threads)});
  }
  s.config_ = model.config;
  s.scene_.normalized_from_world = model.scene.normalized_from_world;
  s.posed_ = sfm::ReadTransformsJson(PosesPath(run));
  ReportMissing(s.posed_, s.listener_);
  s.ReadPhotographs();
  s.trainer_ = std::make_unique<Trainer>(checkpoint, s.data_, run, s.watch_.Seconds());
  return session;
}

}  // namespace nerf
