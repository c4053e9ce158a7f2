#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "nerf/scene/posed_images.h"
#include "sfm/colmap_database.h"
#include "sfm/colmap_images.h"
#include "sfm/colmap_options.h"
#include "sfm/colmap_program.h"
#include "sfm/photo_folder.h"
#include "sfm/step_ledger.h"

namespace nerf::sfm {

// The steps from photographs to models, one method each, to be called in this order. A step that
// was finished in the workspace from the same inputs is skipped, with a log message. Every method
// throws InputError when COLMAP is missing or fails, naming step, reason and log file.
class ColmapSteps {
 public:
  // Creates the workspace, or continues that of an earlier call. Throws InputError where the folder
  // contains other files.
  //   photos  their number, for showing progress
  ColmapSteps(std::filesystem::path workspace, const ColmapOptions& options, int photos);

  // Creates images/, the input of COLMAP.
  //   files  all files, readable or not; when one changes, all steps are repeated
  void PrepareImages(const std::vector<PhotoFile>& files, const std::vector<Photo>& photos,
                     const std::vector<ColmapImage>& plan);
  // Writes cameras (one per folder of images/) and SIFT features to database.db.
  void ExtractFeatures();
  // Writes verified matches to database.db. An interrupted match continues with the remaining
  // pairs.
  //   matcher  "exhaustive", "sequential" or "guided"
  void Match(const std::string& matcher);
  // Writes the models to sparse/0, sparse/1, ..., one for each part of the scene that could not be
  // connected to the others.
  void Map();
  // Matches the pairs that guided matching skipped and maps again. Of more than 300 photographs
  // only more of the similar ones, and those that are not registered with those that are. Adds its
  // models to those of Map.
  void MatchAllAndMap(const std::set<std::string>& registered);
  // Maps again with lower thresholds. Adds its models to those of Map.
  void MapRelaxed();

  // The models that were found, those with most photographs first.
  std::vector<std::filesystem::path> Models() const;
  PosedImages ReadModel(const std::filesystem::path& model) const;

  std::filesystem::path Sparse() const { return workspace_ / "sparse"; }
  std::filesystem::path Database() const { return workspace_ / "database.db"; }
  std::filesystem::path LogFile(const std::string& step) const;
  // The seconds that each step took; for a skipped step those of the call that executed it.
  const std::vector<std::pair<std::string, double>>& Seconds() const { return seconds_; }

 private:
  using Arguments = std::vector<std::string>;

  std::filesystem::path Images() const { return workspace_ / "images"; }

  // Calls work(state) unless the step was finished from the same inputs and its result exists.
  void Step(const std::string& name, const nlohmann::json& inputs,
            const std::filesystem::path& result,
            const std::function<void(StepLedger::State)>& work);
  // Adds an option under the name that this version of COLMAP has for it; none where it has none.
  void AddKnown(const std::string& command, const std::vector<std::string>& names,
                const std::string& value, Arguments& arguments);
  void AddThreads(const std::string& command, const std::vector<std::string>& names,
                  Arguments& arguments);
  ColmapProgram::Outcome Run(const std::string& step, const std::string& command,
                             const Arguments& arguments) const;
  void RunOrThrow(const std::string& step, const std::string& command,
                  const Arguments& arguments) const;
  int FirstOctave() const;
  std::vector<ImagePair> SimilarPairs(const ColmapDatabase& database, int each) const;
  std::vector<ImagePair> RemainingPairs(const ColmapDatabase& database,
                                        const std::set<std::string>& registered) const;
  void MatchInParts(const std::string& step, const std::vector<ImagePair>& pairs,
                    ColmapDatabase& database) const;
  void MapAgain(const std::string& step, const Arguments& thresholds);
  void RunMapper(const std::string& step, const std::filesystem::path& target,
                 const Arguments& thresholds);

  ColmapProgram colmap_;  // first, so that nothing is written where it is missing
  std::filesystem::path workspace_;
  ColmapOptions options_;
  int photos_;
  int longest_side_ = 0;  // pixels
  StepLedger ledger_;
  std::vector<std::pair<std::string, double>> seconds_;
};

}  // namespace nerf::sfm
