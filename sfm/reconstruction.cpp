#include "sfm/reconstruction.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <set>

#include "nerf/base/atomic_file.h"
#include "nerf/base/input_error.h"
#include "nerf/base/parallel.h"
#include "nerf/base/progress.h"
#include "sfm/colmap_database.h"
#include "sfm/colmap_estimate.h"
#include "sfm/colmap_model.h"
#include "sfm/colmap_steps.h"
#include "sfm/colmap_text_writer.h"

namespace nerf::sfm {
namespace {

namespace fs = std::filesystem;

constexpr double kEnough = 0.9;         // of the photographs registered
constexpr double kWorthwhile = 0.2;     // of the photographs of a broken model
constexpr std::size_t kMostJudged = 4;  // models of one attempt, the largest
// Of the second attempt, for captures with hardly any texture.
constexpr int kFinerFeatures = 8192;

// Whether a model is to be preferred.
bool IsBetter(const Reconstruction& a, const Reconstruction& b) {
  if (b.posed.images.empty()) return !a.posed.images.empty();
  const auto photographs = [](const Reconstruction& r) {
    return static_cast<double>(r.posed.images.size());
  };
  const bool a_broken = a.verdict.trust == Trust::kBroken;
  const bool b_broken = b.verdict.trust == Trust::kBroken;
  // However little of a broken model is right, a tiny one is no help either.
  if (a_broken && !b_broken) return photographs(b) < kWorthwhile * photographs(a);
  if (b_broken && !a_broken) return photographs(a) >= kWorthwhile * photographs(b);
  if (a.verdict.trust < b.verdict.trust) return photographs(a) >= kEnough * photographs(b);
  if (a.verdict.trust > b.verdict.trust) return photographs(b) < kEnough * photographs(a);
  return photographs(a) > photographs(b);
}

// Judges the models of one attempt, and keeps the best so far.
//   good  all models that are good, added to
void TakeBest(const ColmapSteps& steps, Reconstruction& best, std::vector<PosedImages>& good) {
  const std::vector<fs::path> models = steps.Models();
  if (models.empty()) return;
  const ColmapDatabase database(steps.Database());
  for (std::size_t i = 0; i < std::min(models.size(), kMostJudged); ++i) {
    Reconstruction candidate;
    candidate.posed = steps.ReadModel(models[i]);
    candidate.verdict = JudgeReconstruction(candidate.posed, MatchesOf(candidate.posed, database));
    if (candidate.verdict.trust == Trust::kGood && !candidate.verdict.figures.misplaced.empty()) {
      // A few photographs at a wrong place do more harm than their absence.
      candidate.misplaced = static_cast<int>(candidate.verdict.figures.misplaced.size());
      candidate.posed = WithoutImages(candidate.posed, candidate.verdict.figures.misplaced);
      candidate.verdict =
          JudgeReconstruction(candidate.posed, MatchesOf(candidate.posed, database));
    }
    if (candidate.verdict.trust == Trust::kBroken) {
      best.largest_broken =
          std::max(best.largest_broken, static_cast<int>(candidate.posed.images.size()));
    }
    if (candidate.verdict.trust == Trust::kGood) good.push_back(candidate.posed);
    if (!IsBetter(candidate, best)) continue;
    best.model = models[i];
    best.misplaced = candidate.misplaced;
    best.posed = std::move(candidate.posed);
    best.verdict = std::move(candidate.verdict);
  }
}

// Records the model that was taken, for other programs and for nerf train: without what was left
// out.
void Choose(const fs::path& sparse, Reconstruction& best) {
  if (best.model.empty()) return;
  if (best.misplaced > 0) {
    best.model = best.model.parent_path().parent_path() / "chosen" / "0";
    MakeOutputFolder(best.model);
    WriteColmapText(best.posed, best.model);
  }
  ChooseModel(sparse, best.model);
}

std::set<std::string> NamesOf(const PosedImages& posed) {
  std::set<std::string> names;
  for (const PosedImage& image : posed.images) names.insert(image.name);
  return names;
}

bool IsEnough(const Reconstruction& best, int photos) {
  return !best.verdict.features_may_help &&
         static_cast<double>(best.posed.images.size()) >= kEnough * photos;
}

void Say(const Reconstruction& best, int photos, const std::string& next) {
  spdlog::info("{} of {} registered{}; {}", best.posed.images.size(), photos,
               best.posed.images.empty() || best.verdict.trust == Trust::kGood
                   ? ""
                   : fmt::format(", {}", NameOf(best.verdict.trust)),
               next);
}

void AddSeconds(const ColmapSteps& steps, const std::string& prefix, Reconstruction& best) {
  for (const auto& [step, seconds] : steps.Seconds()) {
    best.seconds.emplace_back(prefix + step, seconds);
  }
}

// More and finer features, and then lower thresholds.
void TryFiner(const fs::path& workspace, const ColmapOptions& options,
              const std::vector<PhotoFile>& files, const std::vector<Photo>& photos,
              const std::vector<ColmapImage>& plan, const std::string& matcher,
              Reconstruction& best, std::vector<PosedImages>& good) {
  const int count = static_cast<int>(photos.size());
  int side = 0;
  for (const Photo& photo : photos) side = std::max({side, photo.width, photo.height});
  ColmapOptions finer = options;
  finer.max_num_features = std::max(options.max_num_features, kFinerFeatures);
  finer.enlarge = side <= options.max_image_size;
  finer.max_image_size = 2 * options.max_image_size;
  const int threads = options.threads > 0 ? options.threads : NumThreads();
  Say(best, count,
      fmt::format("trying again with more and finer features, which takes about {}",
                  FormatDuration(EstimatePoseSeconds(count, finer.enlarge ? 2 * side : side, finer,
                                                     threads))));
  ColmapSteps again(workspace / "finer", finer, count);
  again.PrepareImages(files, photos, plan);
  again.ExtractFeatures();
  again.Match(matcher);
  again.Map();
  TakeBest(again, best, good);
  if (2 * best.posed.images.size() < photos.size() || best.verdict.trust == Trust::kBroken) {
    Say(best, count, "mapping again with lower thresholds");
    again.MapRelaxed();
    TakeBest(again, best, good);
  }
  AddSeconds(again, "finer_", best);
}

}  // namespace

Reconstruction Reconstruct(const fs::path& workspace, const ColmapOptions& options,
                           const std::vector<PhotoFile>& files, const std::vector<Photo>& photos,
                           const std::vector<ColmapImage>& plan, const std::string& matcher) {
  const int count = static_cast<int>(photos.size());
  Reconstruction best;
  std::vector<PosedImages> good;
  ColmapSteps steps(workspace, options, count);
  best.log = steps.LogFile("mapper").parent_path();
  steps.PrepareImages(files, photos, plan);
  steps.ExtractFeatures();
  steps.Match(matcher);
  steps.Map();
  TakeBest(steps, best, good);
  if (matcher == "guided" && !IsEnough(best, count)) {
    Say(best, count, "matching the remaining pairs");
    steps.MatchAllAndMap(NamesOf(best.posed));
    TakeBest(steps, best, good);
  }
  AddSeconds(steps, "", best);
  if (!IsEnough(best, count)) {
    try {
      TryFiner(workspace, options, files, photos, plan, matcher, best, good);
    } catch (const InputError& error) {
      if (best.posed.images.empty()) throw;
      spdlog::warn("the attempt with more features failed: {}", error.what());
    }
  }
  JudgeAgreement(best.posed, good, best.verdict);
  Choose(steps.Sparse(), best);
  return best;
}

std::optional<ReconstructionVerdict> JudgeAgain(const fs::path& model, const PosedImages& posed) {
  const fs::path workspace = fs::absolute(model).lexically_normal().parent_path().parent_path();
  for (const char* file : {"steps.json", "database.db"}) {
    if (!fs::is_regular_file(workspace / file)) return std::nullopt;
  }
  return JudgeReconstruction(posed, MatchesOf(posed, ColmapDatabase(workspace / "database.db")));
}

}  // namespace nerf::sfm
