#include "nerf/inspect/inspect.h"

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "nerf/commands/commands.h"
#include "nerf/commands/threads.h"
#include "nerf/data/image_io.h"
#include "nerf/inspect/picture.h"
#include "sfm/input_error.h"
#include "sfm/masks.h"
#include "sfm/pose_input.h"
#include "sfm/progress.h"

namespace nerf {
namespace {

struct InspectArguments {
  std::string input;
  int threads = 0;
  bool json = false;
  std::string picture;
};

nlohmann::json JsonFrom(const sfm::PosedImages& posed, const Inspection& inspection) {
  nlohmann::json verdicts = nlohmann::json::array(), exposures = nlohmann::json::object();
  for (const Verdict& v : inspection.verdicts) {
    nlohmann::json one = {{"effect", v.effect}, {"evidence", v.evidence}, {"decided", v.decided},
                          {"on", v.on},         {"sure", v.Sure()},       {"figure", v.figure}};
    if (v.threshold > 0) one["threshold"] = v.threshold;
    verdicts.push_back(one);
  }
  for (std::size_t i = 0; i < inspection.stops.size(); ++i) {
    exposures[posed.images[i].name] = inspection.stops[i];
  }
  return {{"verdicts", verdicts}, {"exposure_stops", exposures}};
}

void RunInspect(const InspectArguments& arguments) {
  UseThreads(arguments.threads);
  const sfm::InputLocation location = sfm::FindInput(arguments.input);
  if (location.kind == sfm::InputKind::kPhotos) {
    throw sfm::InputError(
        "{}: plain photographs have no poses yet; nerf train finds them and inspects, or run nerf "
        "poses first",
        arguments.input);
  }
  sfm::PosedImages posed = sfm::ReadPosedInput(location);
  sfm::FindMasks(posed);
  sfm::ProgressLine progress("looking", static_cast<std::int64_t>(posed.images.size()));
  const Inspection inspection = Inspect(posed, [&](int read) { progress.Update(read); });
  progress.Finish();
  if (!inspection.warning.empty()) spdlog::warn("{}", inspection.warning);
  if (!arguments.picture.empty()) WriteImage(arguments.picture, PictureOf(inspection));
  if (arguments.json) {
    fmt::print(
        "{}\n",
        JsonFrom(posed, inspection).dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
  } else {
    fmt::print("{}", TableOf(inspection.verdicts));
  }
}

}  // namespace

void AddInspectCommand(CLI::App& app) {
  auto* command = app.add_subcommand("inspect", "Which effects a capture calls for, and why");
  const auto arguments = std::make_shared<InspectArguments>();
  command
      ->add_option("input", arguments->input,
                   "COLMAP project (its sparse points tell most), transforms.json, or LLFF folder")
      ->required();
  command->add_option("--threads", arguments->threads, "0: all cores")->capture_default_str();
  command->add_flag("--json", arguments->json, "print JSON instead of the table");
  command->add_option(
      "--picture", arguments->picture,
      "FILE.png to draw: exposure of each photograph, and how much "
      "points change with the angle of the view, which rises where things are glossy");
  command->footer(
      "Examples:\n"
      "  nerf inspect photos/fox/colmap --picture fox.png\n"
      "  nerf inspect photos/fox/colmap\n"
      "  nerf sample drift --calls-for exposure && nerf inspect drift/truth/sparse");
  command->callback([arguments] { RunInspect(*arguments); });
}

}  // namespace nerf
