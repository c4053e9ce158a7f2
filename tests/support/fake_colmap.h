#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "sfm/colmap_text_writer.h"
#include "tests/support/colmap_database_file.h"
#include "tests/support/scratch_folder.h"

namespace nerf::test {

// A fake program `colmap`, first in PATH during the lifetime of this object. It records its calls
// and writes made-up text models. Files beside it define its behaviour:
//   help               output of COMMAND -h
//   version            output of help
//   models             models that `mapper` writes, one per line: number and count of images
//   models_relaxed     the same for the call with lower thresholds
//   do_COMMAND         shell commands to run instead
//   features.db        the database that `feature_extractor` writes; it has no photographs
//   size               width and height of images that are not in a folder named by their size
class FakeColmap {
 public:
  FakeColmap() : old_path_(std::getenv("PATH")) {
    folder_.Write("colmap", kScript);
    std::filesystem::permissions(folder_.path() / "colmap", std::filesystem::perms::owner_all);
    Set("help",
        "--SiftExtraction.use_gpu arg\n--SiftExtraction.max_image_size arg\n"
        "--SiftExtraction.first_octave arg\n"
        "--Mapper.ba_global_images_ratio arg\n");
    Set("version", "COLMAP 3.8 -- Structure-from-Motion and Multi-View Stereo\n");
    Set("models", "");
    Set("models_relaxed", "");
    Set("size", "64 48");
    WriteColmapDatabase(folder_.path() / "features.db", {});
    setenv("PATH", (folder_.path().string() + ":" + old_path_).c_str(), 1);
  }
  ~FakeColmap() { setenv("PATH", old_path_.c_str(), 1); }

  void Set(const std::string& file, const std::string& text) const { folder_.Write(file, text); }
  std::string Get(const std::string& file) const {
    std::ifstream stream(folder_.path() / file);
    std::stringstream text;
    text << stream.rdbuf();
    return text.str();
  }
  // What `feature_extractor` finds.
  void SetFeatures(const std::vector<DatabaseImage>& images) const {
    WriteColmapDatabase(folder_.path() / "features.db", images);
  }
  // A model that `mapper` writes. Its images are those of the test, by their names.
  void SetModel(const PosedImages& model) const {
    std::filesystem::create_directories(folder_.path() / "model");
    sfm::WriteColmapText(model, folder_.path() / "model");
    Set("do_mapper", "mkdir -p \"$output/0\"; cp \"$here/model/\"*.txt \"$output/0\"");
  }
  void Unset(const std::string& file) const { std::filesystem::remove(folder_.path() / file); }

  // All calls except "-h", with their arguments.
  std::vector<std::string> Calls() const {
    std::ifstream file(folder_.path() / "calls");
    std::vector<std::string> calls;
    for (std::string line; std::getline(file, line);) calls.push_back(line);
    return calls;
  }
  // Only their first words.
  std::vector<std::string> Commands() const {
    std::vector<std::string> commands;
    for (const std::string& call : Calls()) commands.push_back(call.substr(0, call.find(' ')));
    return commands;
  }
  void ForgetCalls() const { Unset("calls"); }

 private:
  static constexpr const char* kScript = R"sh(#!/bin/sh
here=$(dirname "$0")
command=$1
if [ "$1" = help ]; then cat "$here/version"; exit 0; fi
if [ "$2" = -h ]; then cat "$here/help"; exit 0; fi
echo "$@" >> "$here/calls"
models=$here/models
while [ $# -gt 1 ]; do
  case $1 in
    --image_path) images=$2;;
    --output_path) output=$2;;
    --database_path) database=$2;;
    --Mapper.init_min_num_inliers) models=$here/models_relaxed;;
  esac
  shift
done
if [ -f "$here/do_$command" ]; then . "$here/do_$command"; exit; fi
case $command in
  feature_extractor) echo 'Processed file [1/1]'; cp "$here/features.db" "$database";;
esac
[ $command = mapper ] || exit 0
read width height < "$here/size"
while read model count; do
  mkdir -p "$output/$model"
  cd "$output/$model"
  : > cameras.txt; : > images.txt
  echo '1 0 0 1 255 0 0 0.5 1 0' > points3D.txt
  (cd "$images" && find . ! -type d | sort | head -n $count) | {
    id=0
    while read -r name; do
      name=${name#./}; id=$((id + 1)); w=$width; h=$height
      case $name in */*) size=${name%%/*}; w=${size%x*}; h=${size#*x};; esac
      echo "$id PINHOLE $w $h 50 50 $((w / 2)) $((h / 2))" >> cameras.txt
      echo "$id 1 0 0 0 $id 0 0 $id $name" >> images.txt
      if [ $id = 1 ]; then echo '10 10 1' >> images.txt; else echo >> images.txt; fi
    done
  }
done < "$models"
)sh";

  ScratchFolder folder_;
  std::string old_path_;
};

}  // namespace nerf::test
