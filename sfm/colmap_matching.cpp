// The matching steps of ColmapSteps.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "nerf/base/atomic_file.h"
#include "nerf/base/progress.h"
#include "sfm/colmap_database.h"
#include "sfm/colmap_steps.h"

namespace nerf::sfm {
namespace {

namespace fs = std::filesystem;

constexpr int kSequenceOverlap = 20;  // neighbours

// Guided matching: features per photograph of the coarse exhaustive match, pairs per photograph
// that are matched with all features, and neighbours by name that are always matched.
constexpr int kCoarseFeatures = 512;
constexpr int kPairsEach = 12;
constexpr int kNeighbours = 2;
const char* const kCoarse = "coarse.db";
const char* const kPairs = "pairs.txt";

}  // namespace

void ColmapSteps::Match(const std::string& matcher) {
  Step("matches", {matcher}, Database(), [&](StepLedger::State state) {
    // Left by an interrupted guided match.
    RemoveDatabase(workspace_ / kCoarse);
    RemoveAll(workspace_ / kPairs);
    // COLMAP itself skips pairs that are already matched.
    if (state == StepLedger::State::kChanged) {
      RunOrThrow("clean", "database_cleaner",
                 {"--database_path", Database().string(), "--type", "matches"});
    }
    if (matcher == "sequential") return MatchSequentially();
    if (matcher == "guided") return MatchGuided();
    MatchExhaustively("matches");
  });
}

void ColmapSteps::MatchExhaustively(const std::string& step) {
  Arguments arguments = MatchingArguments("exhaustive_matcher", Database());
  // COLMAP reports progress per block: about 64 times, whatever the number of photographs.
  AddKnown("exhaustive_matcher", {"ExhaustiveMatching.block_size"}, std::clamp(photos_ / 8, 8, 50),
           arguments);
  RunOrThrow(step, "exhaustive_matcher", arguments);
}

void ColmapSteps::MatchSequentially() {
  // Neighbours first, then those at distances of powers of two: up to COLMAP 3.10 the second pass
  // includes the first, from 3.11 on it has only its own pairs. Matched pairs are skipped.
  const std::string command = "sequential_matcher";
  const bool has_option =
      !colmap_.KnownOption(command, {"SequentialMatching.quadratic_overlap"}).empty();
  for (int quadratic = has_option ? 0 : 1; quadratic <= 1; ++quadratic) {
    Arguments arguments = MatchingArguments(command, Database());
    AddKnown(command, {"SequentialMatching.overlap"}, kSequenceOverlap, arguments);
    AddKnown(command, {"SequentialMatching.quadratic_overlap"}, quadratic, arguments);
    RunOrThrow("matches", command, arguments);
  }
}

void ColmapSteps::MatchGuided() {
  const fs::path coarse = workspace_ / kCoarse;
  CopyLargestFeatures(Database(), coarse, kCoarseFeatures);
  RunOrThrow("matches_coarse", "exhaustive_matcher",
             MatchingArguments("exhaustive_matcher", coarse));
  const auto names = ReadImageNames(Database());
  const auto pairs = SelectPairs(ReadMatchedPairs(coarse), names, kPairsEach, kNeighbours);
  RemoveDatabase(coarse);
  // COLMAP reports nothing before it has matched all pairs of a list, so lists are short.
  const fs::path list = workspace_ / kPairs;
  const std::size_t part = std::max<std::size_t>(32, pairs.size() / 20);
  ProgressLine progress("matches", static_cast<std::int64_t>(pairs.size()));
  for (std::size_t first = 0; first < pairs.size(); first += part) {
    std::string text;
    for (std::size_t i = first; i < std::min(pairs.size(), first + part); ++i) {
      text += pairs[i].first + " " + pairs[i].second + "\n";
    }
    WriteFileAtomically(list, text);
    Arguments arguments = MatchingArguments("matches_importer", Database());
    arguments.insert(arguments.end(),
                     {"--match_list_path", list.string(), "--match_type", "pairs"});
    RunOrThrow("matches", "matches_importer", arguments);
    progress.Update(static_cast<std::int64_t>(std::min(pairs.size(), first + part)));
  }
  RemoveAll(list);
}

ColmapSteps::Arguments ColmapSteps::MatchingArguments(const std::string& command,
                                                      const fs::path& database) {
  Arguments arguments = {"--database_path", database.string()};
  AddKnown(command, {"SiftMatching.use_gpu", "FeatureMatching.use_gpu"}, 0, arguments);
  AddThreads(command, {"SiftMatching.num_threads", "FeatureMatching.num_threads"}, arguments);
  return arguments;
}

}  // namespace nerf::sfm
