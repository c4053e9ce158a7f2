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
#include "nerf/synthetic/sparse_points.h"
#include "nerf/synthetic/wrong_poses.h"
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

// Whether a file carries a name that WriteSample gives, or that a writer of ours gives to a file it
// has not finished: what an interrupted run leaves behind must not stand in the way of the next.
bool IsOurs(const std::string& name) {
  static const std::regex ours(
      R"(view_\d{3}\.(png|exr|depth\.exr|normal\.exr|albedo\.exr))"
      R"(|((transforms|poses)\.json|(cameras|images|points3D)\.txt)(\.tmp\d+)?)"
      R"(|\.view_\d{3}\..*)");
  return std::regex_match(name, ours);
}

std::vector<fs::path> FilesIn(const fs::path& folder) {
  std::vector<fs::path> files;
  if (!fs::exists(folder)) return files;
  for (const auto& entry : fs::directory_iterator(folder)) files.push_back(entry.path());
  return files;
}

// A folder that holds photographs of somebody's must not be mixed with ours.
void RefuseUnlessSample(const fs::path& folder) {
  if (!fs::exists(folder)) return;
  if (!fs::is_directory(folder)) {
    throw InputError("{} is a file: choose an empty or a new folder", folder.string());
  }
  if (!fs::is_empty(folder) && !fs::is_directory(folder / "truth")) {
    throw InputError("{} holds files that are no sample: choose an empty or a new folder",
                     folder.string());
  }
  for (const char* part : kParts) {
    for (const fs::path& file : FilesIn(folder / part)) {
      const std::string name = file.filename().string();
      if (fs::is_directory(file) ? name == kSparse : IsOurs(name)) continue;
      throw InputError("{} is no part of a sample: choose an empty or a new folder", file.string());
    }
  }
}

// Views of an earlier, longer sample would be taken for views of this one.
void RemoveWhatIsLeftOver(const fs::path& folder, const PosedImages& posed, Occasion occasion) {
  if (occasion != Occasion::kMasks) fs::remove_all(folder / "masks");
  std::set<std::string> wanted = {"transforms.json", kSparse, "cameras.txt", "images.txt",
                                  "points3D.txt"};
  if (occasion == Occasion::kPoses) wanted.insert(kTruePoses);
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
    RefuseUnlessSample(folder);
    // `truth` comes first: it is the mark by which a folder is known as a sample.
    fs::create_directories(folder / "truth" / "sparse");
    fs::create_directories(folder / "images");
    if (options.occasion == Occasion::kMasks) fs::create_directories(folder / "masks");
    RemoveWhatIsLeftOver(folder, posed, options.occasion);
  } catch (const fs::filesystem_error& e) {
    throw InputError("{} cannot be written ({}): choose a folder that is yours", folder.string(),
                     e.code().message());
  }
  const Scene scene = SceneOf(options.occasion);
  posed.points = SparsePoints(scene, posed, options);
  PosedImages handed_over = posed;
  if (options.occasion == Occasion::kPoses) {
    sfm::WriteTransformsJson(posed, folder / "truth" / kTruePoses);
    handed_over = WithWrongPoses(posed, options.seed);
  }
  sfm::WriteTransformsJson(handed_over, folder / "truth" / "transforms.json");
  sfm::WriteColmapText(handed_over, folder / "truth" / "sparse");
  ProgressLine progress("rendering", options.views);
  progress.Update(0);
  int done = 0;
  RenderViews(scene, posed, options, [&](int i, const View& view) {
    WriteView(folder, posed.images[i].name, view);
    progress.Update(++done, posed.images[i].name);
  });
}

}  // namespace nerf::synthetic
