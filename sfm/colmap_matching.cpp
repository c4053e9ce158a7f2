// The matching steps of ColmapSteps.
#include <nlohmann/json.hpp>

#include "nerf/base/progress.h"
#include "sfm/colmap_database.h"
#include "sfm/colmap_steps.h"
#include "sfm/pair_matching.h"
#include "sfm/pair_selection.h"

namespace nerf::sfm {
namespace {

constexpr int kSequenceOverlap = 20;  // neighbours

// Guided matching: pairs per photograph, and neighbours by name that are always matched.
constexpr int kPairsEach = 12;
constexpr int kNeighbours = 2;

// Instead of all pairs where these would be too many: time and memory grow with the photographs.
constexpr int kMostForAllPairs = 300, kManyPairsEach = 60;
constexpr std::size_t kMostGuided = 40000;

}  // namespace

void ColmapSteps::Match(const std::string& matcher) {
  Step("matches", {matcher}, Database(), [&](StepLedger::State state) {
    ColmapDatabase database(Database());
    if (state == StepLedger::State::kChanged) database.RemoveMatches();
    const int count = static_cast<int>(database.Names().size());
    std::vector<ImagePair> pairs;
    if (matcher == "sequential") {
      pairs = SequentialPairs(count, kSequenceOverlap);
    } else if (matcher == "guided") {
      pairs = SimilarPairs(database, kPairsEach);
    } else {
      pairs = AllPairs(count);
    }
    MatchInParts("matches", pairs, database);
  });
}

std::vector<ImagePair> ColmapSteps::SimilarPairs(const ColmapDatabase& database, int each) const {
  const int count = static_cast<int>(database.Names().size());
  ProgressLine line("comparing photographs", count);
  return MostSimilarPairs(
      CompareAllPairs(database, options_.threads, [&](int done) { line.Update(done); }), count,
      each, kNeighbours);
}

void ColmapSteps::MatchInParts(const std::string& step, const std::vector<ImagePair>& pairs,
                               ColmapDatabase& database) const {
  ProgressLine line(step, static_cast<std::int64_t>(pairs.size()));
  MatchPairs(database, pairs, options_.threads,
             [&](std::size_t done) { line.Update(static_cast<std::int64_t>(done)); });
}

std::vector<ImagePair> ColmapSteps::RemainingPairs(const ColmapDatabase& database,
                                                   const std::set<std::string>& registered) const {
  const int count = static_cast<int>(database.Names().size());
  if (count <= kMostForAllPairs) return AllPairs(count);
  std::vector<int> inside, outside;
  for (int i = 0; i < count; ++i) {
    (registered.contains(database.Names()[i]) ? inside : outside).push_back(i);
  }
  return Joined(SimilarPairs(database, kManyPairsEach), PairsBetween(outside, inside, kMostGuided));
}

void ColmapSteps::MatchAllAndMap(const std::set<std::string>& registered) {
  Step("matches_all", nlohmann::json::object(), Database(), [&](StepLedger::State) {
    ColmapDatabase database(Database());
    MatchInParts("matches_all", RemainingPairs(database, registered), database);
  });
  MapAgain("mapper_all", {});
}

}  // namespace nerf::sfm
