#pragma once

#include <filesystem>
#include <functional>
#include <initializer_list>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

#include "nerf/scene/posed_images.h"
#include "sfm/colmap_images.h"
#include "sfm/colmap_options.h"
#include "sfm/colmap_program.h"
#include "sfm/photo_folder.h"
#include "sfm/step_ledger.h"

namespace nerf::sfm {

// The steps from photographs to models, each in a method, to be called in this order. A step that
// the workspace has finished already, from the same inputs, is skipped, and the log says so.
// Every method throws InputError when COLMAP is missing or fails, naming step, reason and log file.
class ColmapSteps {
 public:
  // Makes the workspace, or takes up the one of an earlier call. photos: how many there are, for
  // the progress shown. Throws InputError where the folder holds anything else.
  ColmapSteps(std::filesystem::path workspace, const ColmapOptions& options, int photos);

  // images/: what COLMAP sees. files: all that was looked at, readable or not; when one of them
  // changes, everything is done again.
  void PrepareImages(const std::vector<std::filesystem::path>& files,
                     const std::vector<Photo>& photos, const std::vector<ColmapImage>& plan);
  // database.db: cameras (one a folder of images/) and SIFT features.
  void ExtractFeatures();
  // database.db: verified matches. An interrupted match goes on with the pairs that are left.
  //   matcher  "exhaustive", "sequential" or "guided"
  void Match(const std::string& matcher);
  // sparse/0, sparse/1, ...: a model for each part that could not be joined to the others.
  void Map();
  // Both add their models to those of Map, numbered on.
  // The pairs that a guided match left out, and the mapper once more.
  void MatchAllAndMap();
  // The mapper once more, with lower thresholds.
  void MapRelaxed();

  // Of the model with most registered photographs; 0 and an error where there is no model.
  int Registered() const;
  PosedImages ReadModel() const;

  std::filesystem::path LogFile(const std::string& step) const;
  // Step by step; of a skipped step those of the call that did it.
  const std::vector<std::pair<std::string, double>>& Seconds() const { return seconds_; }

 private:
  using Arguments = std::vector<std::string>;

  std::filesystem::path Images() const { return workspace_ / "images"; }
  std::filesystem::path Database() const { return workspace_ / "database.db"; }
  std::filesystem::path Sparse() const { return workspace_ / "sparse"; }

  // Does the work of a step unless it is done already, from the same inputs and with its result in
  // place. The work is told in which state it finds the step.
  void Step(const std::string& name, const nlohmann::json& inputs,
            const std::filesystem::path& result,
            const std::function<void(StepLedger::State)>& work);
  // Adds an option by the name that this COLMAP has for it; nothing where it has none.
  void AddKnown(const std::string& command, std::initializer_list<const char*> names, int value,
                Arguments& arguments);
  void AddThreads(const std::string& command, std::initializer_list<const char*> names,
                  Arguments& arguments);
  ColmapProgram::Outcome Run(const std::string& step, const std::string& command,
                             const Arguments& arguments) const;
  void RunOrThrow(const std::string& step, const std::string& command,
                  const Arguments& arguments) const;
  int FirstOctave() const;
  Arguments MatchingArguments(const std::string& command, const std::filesystem::path& database);
  void MatchExhaustively(const std::string& step);
  void MatchSequentially();
  void MatchGuided();
  void MapAgain(const std::string& step, const Arguments& thresholds);
  void RunMapper(const std::string& step, const std::filesystem::path& target,
                 const Arguments& thresholds);

  ColmapProgram colmap_;  // first: where it is missing, nothing is written
  std::filesystem::path workspace_;
  ColmapOptions options_;
  int photos_;
  int longest_side_ = 0;  // pixels
  StepLedger ledger_;
  std::vector<std::pair<std::string, double>> seconds_;
};

}  // namespace nerf::sfm
