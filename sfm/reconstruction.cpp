#include "sfm/reconstruction.h"

#include <spdlog/spdlog.h>

#include <algorithm>

#include "sfm/colmap_database.h"
#include "sfm/colmap_model.h"
#include "sfm/colmap_steps.h"

namespace nerf::sfm {
namespace {

namespace fs = std::filesystem;

constexpr double kEnough = 0.9;         // of the photographs registered
constexpr std::size_t kMostJudged = 4;  // models of one attempt, the largest
// Of the second attempt, for captures with hardly any texture.
constexpr int kFinerFeatures = 8192, kFinerSize = 3200;

// Whether a model is to be preferred.
bool IsBetter(const Reconstruction& a, const Reconstruction& b) {
  if (b.posed.images.empty()) return !a.posed.images.empty();
  const auto photographs = [](const Reconstruction& r) {
    return static_cast<double>(r.posed.images.size());
  };
  const bool a_broken = a.verdict.trust == Trust::kBroken;
  const bool b_broken = b.verdict.trust == Trust::kBroken;
  if (a_broken != b_broken) return b_broken;
  if (a.verdict.trust < b.verdict.trust) return photographs(a) >= kEnough * photographs(b);
  if (a.verdict.trust > b.verdict.trust) return photographs(b) < kEnough * photographs(a);
  return photographs(a) > photographs(b);
}

// Judges the models of one attempt, and keeps the best so far.
void TakeBest(const ColmapSteps& steps, Reconstruction& best) {
  const std::vector<fs::path> models = steps.Models();
  if (models.empty()) return;
  const ColmapDatabase database(steps.Database());
  for (std::size_t i = 0; i < std::min(models.size(), kMostJudged); ++i) {
    Reconstruction candidate;
    candidate.posed = steps.ReadModel(models[i]);
    best.largest = std::max(best.largest, static_cast<int>(candidate.posed.images.size()));
    candidate.verdict = JudgeReconstruction(candidate.posed, MatchesOf(candidate.posed, database));
    if (candidate.verdict.trust == Trust::kGood && !candidate.verdict.figures.misplaced.empty()) {
      // A few photographs at a wrong place do more harm than their absence.
      candidate.posed = WithoutImages(candidate.posed, candidate.verdict.figures.misplaced);
      candidate.verdict =
          JudgeReconstruction(candidate.posed, MatchesOf(candidate.posed, database));
    }
    if (!IsBetter(candidate, best)) continue;
    best.model = models[i];
    best.posed = std::move(candidate.posed);
    best.verdict = std::move(candidate.verdict);
  }
}

bool IsEnough(const Reconstruction& best, int photos) {
  return best.verdict.trust == Trust::kGood &&
         static_cast<double>(best.posed.images.size()) >= kEnough * photos;
}

void Say(const Reconstruction& best, int photos, const std::string& next) {
  spdlog::info("{} of {} registered{}; {}", best.posed.images.size(), photos,
               best.posed.images.empty() || best.verdict.trust == Trust::kGood
                   ? ""
                   : fmt::format(", {}", NameOf(best.verdict.trust)),
               next);
}

}  // namespace

Reconstruction Reconstruct(const fs::path& workspace, const ColmapOptions& options,
                           const std::vector<PhotoFile>& files, const std::vector<Photo>& photos,
                           const std::vector<ColmapImage>& plan, const std::string& matcher) {
  const int count = static_cast<int>(photos.size());
  Reconstruction best;
  ColmapSteps steps(workspace, options, count);
  best.log = steps.LogFile("mapper").parent_path();
  const auto add_seconds = [&best](const ColmapSteps& of, const std::string& prefix) {
    for (const auto& [step, seconds] : of.Seconds()) {
      best.seconds.emplace_back(prefix + step, seconds);
    }
  };
  steps.PrepareImages(files, photos, plan);
  steps.ExtractFeatures();
  steps.Match(matcher);
  steps.Map();
  TakeBest(steps, best);
  if (matcher == "guided" && !IsEnough(best, count)) {
    Say(best, count, "matching the remaining pairs");
    steps.MatchAllAndMap();
    TakeBest(steps, best);
  }
  add_seconds(steps, "");
  if (IsEnough(best, count)) {
    ChooseModel(steps.Sparse(), best.model);
    return best;
  }

  Say(best, count, "trying again with more and finer features");
  ColmapOptions finer = options;
  finer.max_num_features = std::max(options.max_num_features, kFinerFeatures);
  finer.max_image_size = std::max(options.max_image_size, kFinerSize);
  finer.enlarge = true;
  ColmapSteps again(workspace / "finer", finer, count);
  again.PrepareImages(files, photos, plan);
  again.ExtractFeatures();
  again.Match(matcher == "sequential" ? "sequential" : "exhaustive");
  again.Map();
  TakeBest(again, best);
  if (2 * best.posed.images.size() < photos.size() || best.verdict.trust == Trust::kBroken) {
    Say(best, count, "mapping again with lower thresholds");
    again.MapRelaxed();
    TakeBest(again, best);
  }
  add_seconds(again, "finer ");
  if (!best.model.empty()) ChooseModel(steps.Sparse(), best.model);
  return best;
}

}  // namespace nerf::sfm
