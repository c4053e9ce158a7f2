#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "nerf/base/input_error.h"
#include "nerf/base/progress.h"
#include "nerf/commands/commands.h"
#include "nerf/commands/threads.h"
#include "nerf/effects/effects.h"
#include "nerf/effects/inspection.h"
#include "nerf/image/image_io.h"
#include "nerf/pipeline/found_points.h"
#include "nerf/pipeline/inspection_picture.h"
#include "sfm/masks.h"
#include "sfm/photo_folder.h"
#include "sfm/pose_input.h"
#include "sfm/reconstruction.h"

namespace nerf {
namespace {

struct InspectArguments {
  std::string input;
  int threads = 0;
  bool json = false, given_points_only = false;
  std::string picture;
};

// What each effect simulates, for --help.
std::string EffectTable() {
  std::string table = "Effects, with the stage of the rays at which they run:\n";
  for (const EffectDescriptor* effect : AllEffects()) {
    table += fmt::format("  {:<17}  {:<14}  {}\n", effect->name, effect->stage, effect->help);
  }
  return table;
}

nlohmann::json JsonFrom(const sfm::ReconstructionVerdict& verdict) {
  const sfm::ReconstructionFigures& f = verdict.figures;
  return {{"verdict", sfm::NameOf(verdict.trust)},
          {"reason", verdict.reason},
          {"photographs", f.registered},
          {"misplaced", f.misplaced.size()},
          {"points", f.points},
          {"points_in_a_photograph", f.observations},
          {"photographs_of_a_point", f.track_length},
          {"angle_degrees", f.angle},
          {"share_of_matches_that_fit", f.fitting},
          {"share_of_points_far_away", f.far}};
}

nlohmann::json JsonFrom(const PosedImages& posed, const Inspection& inspection) {
  nlohmann::json verdicts = nlohmann::json::array(), exposures = nlohmann::json::object();
  for (const Verdict& v : inspection.verdicts) {
    nlohmann::json one = {{"effect", v.effect},           {"evidence", v.evidence},
                          {"decided", v.decided},         {"on", v.on},
                          {"confidence", v.Confidence()}, {"figure", v.figure}};
    if (v.threshold > 0) one["threshold"] = v.threshold;
    verdicts.push_back(one);
  }
  for (std::size_t i = 0; i < inspection.stops.size(); ++i) {
    exposures[posed.images[i].name] = inspection.stops[i];
  }
  return {{"verdicts", verdicts}, {"exposure_stops", exposures}};
}

// Photographs without poses.
PosedImages WithoutPoses(const std::filesystem::path& folder) {
  PosedImages photographs;
  photographs.source = folder;
  const std::vector<sfm::PhotoFile> files = sfm::ListPhotos(folder);
  if (const std::string text = sfm::DescribeSubFolders(files); !text.empty()) {
    photographs.warnings.push_back(fmt::format("{}: {}", folder.string(), text));
  }
  for (const sfm::PhotoFile& file : files) {
    PosedImage image;
    image.name = file.name;
    image.path = file.path;
    image.upright_by_exif = true;
    photographs.images.push_back(image);
  }
  return photographs;
}

// A temporary folder with a unique name (mkdtemp), which is removed with this object.
class WorkFolder {
 public:
  WorkFolder() {
    std::error_code error;
    std::string path = (std::filesystem::temp_directory_path(error) / "nerf-XXXXXX").string();
    if (error || mkdtemp(path.data()) == nullptr) {
      throw InputError("{}: cannot be created; set TMPDIR to a folder that can be written", path);
    }
    path_ = path;
  }
  ~WorkFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;
  const std::filesystem::path& Path() const { return path_; }

 private:
  std::filesystem::path path_;
};

// Finds sparse points for poses without any, if that takes minutes at most.
void FindPoints(PosedImages& posed) {
  constexpr double kMostSeconds = 600;
  if (!posed.points.empty()) return;
  const auto say = [](const PipelineEvent& event) {
    if (const auto* warning = std::get_if<Warning>(&event)) {
      spdlog::warn("{}", warning->text);
    } else if (const auto* found = std::get_if<PointsFound>(&event)) {
      spdlog::info("{}; {}", sfm::Describe(found->report.consistency),
                   sfm::Describe(found->report));
    }
  };
  try {
    const WorkFolder folder;
    FindMissingPoints(posed, folder.Path(), kMostSeconds, say);
  } catch (const InputError& error) {
    spdlog::warn("no sparse points: {}", error.what());
  }
}

// The verdict on poses that nerf has found; nothing for others.
std::optional<sfm::ReconstructionVerdict> JudgePoses(const sfm::InputLocation& location,
                                                     const PosedImages& posed) {
  if (location.kind != sfm::InputKind::kColmap) return std::nullopt;
  try {
    return sfm::JudgeAgain(location.model, posed);
  } catch (const InputError& error) {
    spdlog::warn("{}", error.what());
    return std::nullopt;
  }
}

void RunInspect(const InspectArguments& arguments) {
  UseThreads(arguments.threads);
  const sfm::InputLocation location = sfm::FindInput(arguments.input);
  if (location.kind == sfm::InputKind::kFilm) {
    throw InputError("{}: a film, without poses; run nerf poses on it, and inspect its output",
                     location.images.string());
  }
  const bool has_poses = location.kind != sfm::InputKind::kPhotos;
  PosedImages posed = has_poses ? sfm::ReadPosedInput(location) : WithoutPoses(location.images);
  sfm::FindMasks(posed);
  for (const std::string& warning : posed.warnings) spdlog::warn("{}", warning);
  Inspection inspection;
  if (has_poses) {
    if (!arguments.given_points_only) FindPoints(posed);
    ProgressLine progress("inspecting", static_cast<std::int64_t>(posed.images.size()));
    inspection = Inspect(posed, [&](int read) { progress.Update(read); });
    progress.Finish();
  } else {
    inspection = InspectPhotographs(posed);
    spdlog::warn(
        "{}: photographs without poses, which most verdicts need; find them with nerf poses, or "
        "run nerf train, which finds them and inspects again",
        arguments.input);
  }
  if (!inspection.warning.empty()) spdlog::warn("{}", inspection.warning);
  if (!arguments.picture.empty()) WriteImage(arguments.picture, PictureOf(inspection));
  const auto poses = JudgePoses(location, posed);
  if (arguments.json) {
    nlohmann::json root = JsonFrom(posed, inspection);
    if (poses) root["poses"] = JsonFrom(*poses);
    fmt::print("{}\n", root.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
  } else {
    if (poses) fmt::print("poses: {}\n", sfm::Describe(*poses));
    fmt::print("{}", TableOf(inspection.verdicts));
  }
}

}  // namespace

void AddInspectCommand(CLI::App& app) {
  auto* command = app.add_subcommand("inspect", "Which effects a capture needs, and why");
  const auto arguments = std::make_shared<InspectArguments>();
  command
      ->add_option(
          "input", arguments->input,
          "COLMAP project (best, since it has sparse points), transforms.json, LLFF folder, "
          "or photographs without poses")
      ->required();
  command->add_option("--threads", arguments->threads, "0: all cores")->capture_default_str();
  command->add_flag("--json", arguments->json, "print JSON instead of the table");
  command->add_flag("--given-points-only", arguments->given_points_only,
                    "do not find sparse points where the input has poses but none");
  command->add_option(
      "--picture", arguments->picture,
      "write a plot to FILE.png: the exposure of each photograph, and the colour change of points "
      "with the viewing angle, which increases for glossy surfaces");
  command->footer(EffectTable() +
                  "\nExamples:\n"
                  "  nerf inspect photos/fox/colmap --picture fox.png\n"
                  "  nerf inspect photos/fox/colmap\n"
                  "  nerf sample drift --scenario exposure && nerf inspect drift/truth/sparse");
  command->callback([arguments] { RunInspect(*arguments); });
}

}  // namespace nerf
