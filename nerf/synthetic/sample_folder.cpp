#include "nerf/synthetic/sample_folder.h"

#include <regex>
#include <set>
#include <string>
#include <system_error>
#include <vector>

#include "nerf/base/input_error.h"
#include "nerf/base/progress.h"
#include "nerf/image/image_io.h"
#include "nerf/synthetic/camera_rings.h"
#include "nerf/synthetic/capture.h"
#include "nerf/synthetic/perturbed_poses.h"
#include "nerf/synthetic/sparse_points.h"
#include "sfm/colmap_text_writer.h"
#include "sfm/transforms_json.h"

namespace nerf::synthetic {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMap[] = {"depth", "normal", "albedo"};
constexpr const char* kParts[] = {"images", "masks", "truth", "truth/sparse"};
constexpr const char* kTruePoses = "poses.json";
constexpr const char* kSparse = "sparse";  // folder of a COLMAP model, in truth

std::string MapName(const std::string& photo, const std::string& map) {
  return fs::path(photo).stem().string() + "." + map + ".exr";
}

// Whether a file has a name that WriteSample uses, or that our writers use for unfinished files: an
// interrupted run must not block the next one.
bool IsOurs(const std::string& name) {
  static const std::regex ours(
      R"(view_\d{3}\.(png|exr|depth\.exr|normal\.exr|albedo\.exr))"
      R"(|((transforms|poses)\.json|(cameras|images|points3D)\.txt)(\.tmp\d+)?)"
      R"(|\.(view_\d{3}|transforms|poses|cameras|images|points3D)\..*)");
  return std::regex_match(name, ours);
}

std::vector<fs::path> FilesIn(const fs::path& folder) {
  std::vector<fs::path> files;
  if (!fs::exists(folder)) return files;
  for (const auto& entry : fs::directory_iterator(folder)) files.push_back(entry.path());
  return files;
}

// Protects folders with files that are not from here: throws unless the folder is new, empty, or an
// earlier sample.
void CheckIsSample(const fs::path& folder) {
  if (!fs::exists(folder)) return;
  if (!fs::is_directory(folder)) {
    throw InputError("{} is a file: choose an empty or a new folder", folder.string());
  }
  if (!fs::is_empty(folder) && !fs::is_directory(folder / "truth")) {
    throw InputError("{} contains files, but is not a sample: choose an empty or a new folder",
                     folder.string());
  }
  for (const char* part : kParts) {
    for (const fs::path& file : FilesIn(folder / part)) {
      const std::string name = file.filename().string();
      if (fs::is_directory(file) ? name == kSparse : IsOurs(name)) continue;
      throw InputError("{} is not part of a sample: choose an empty or a new folder",
                       file.string());
    }
  }
}

// Removes the files of an earlier sample that this one does not replace.
void RemoveStaleFiles(const fs::path& folder, const PosedImages& posed, Scenario scenario) {
  if (scenario != Scenario::kMasks) fs::remove_all(folder / "masks");
  std::set<std::string> wanted = {"transforms.json", kSparse, "cameras.txt", "images.txt",
                                  "points3D.txt"};
  if (scenario == Scenario::kPoseRefinement) wanted.insert(kTruePoses);
  for (const auto& image : posed.images) {
    wanted.insert(image.name);
    for (const char* map : kMap) wanted.insert(MapName(image.name, map));
  }
  for (const char* part : kParts) {
    for (const fs::path& file : FilesIn(folder / part)) {
      if (!wanted.contains(file.filename().string())) fs::remove(file);
    }
  }
}

void WriteView(const fs::path& folder, const std::string& name, const View& view) {
  WriteImage(folder / "images" / name, view.photo);
  if (view.mask) {
    WriteImage(folder / "masks" / fs::path(name).replace_extension(".png"), *view.mask);
  }
  WriteImage(folder / "truth" / MapName(name, "depth"), view.depth);
  WriteImage(folder / "truth" / MapName(name, "normal"), view.normal);
  WriteImage(folder / "truth" / MapName(name, "albedo"), view.albedo);
}

}  // namespace

void WriteSample(const fs::path& folder, const SampleOptions& options) {
  PosedImages posed = CameraRings(options);
  for (auto& image : posed.images) image.path = folder / "images" / image.name;
  try {
    CheckIsSample(folder);
    // `truth` is created first: it marks a folder as a sample.
    fs::create_directories(folder / "truth" / "sparse");
    fs::create_directories(folder / "images");
    if (options.scenario == Scenario::kMasks) fs::create_directories(folder / "masks");
    RemoveStaleFiles(folder, posed, options.scenario);
  } catch (const fs::filesystem_error& e) {
    throw InputError("{} cannot be written ({}): choose another folder", folder.string(),
                     e.code().message());
  }
  const Scene scene = SceneFor(options.scenario);
  posed.points = SparsePoints(scene, posed, options);
  PosedImages published = posed;
  if (options.scenario == Scenario::kPoseRefinement) {
    sfm::WriteTransformsJson(posed, folder / "truth" / kTruePoses);
    published = WithPerturbedPoses(posed, options.seed);
  }
  sfm::WriteTransformsJson(published, folder / "truth" / "transforms.json");
  sfm::WriteColmapText(published, folder / "truth" / "sparse");
  ProgressLine progress("rendering", options.views);
  progress.Update(0);
  int done = 0;
  RenderViews(scene, posed, options, [&](int i, const View& view) {
    WriteView(folder, posed.images[i].name, view);
    progress.Update(++done, posed.images[i].name);
  });
}

}  // namespace nerf::synthetic
