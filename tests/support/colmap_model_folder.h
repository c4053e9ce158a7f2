#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "sfm/colmap_model.h"
#include "tests/support/colmap_files.h"
#include "tests/support/input_error_of.h"
#include "tests/support/scratch_folder.h"

namespace nerf::test {

// A model in sparse/ of a scratch folder, and its photographs in images/.
class ColmapModel : public testing::Test {
 protected:
  void WriteFiles(const ColmapFiles& files, const std::string& ending,
                  const std::string& folder = "sparse") {
    scratch_.Write(folder + "/cameras" + ending, files.cameras);
    scratch_.Write(folder + "/images" + ending, files.images);
    scratch_.Write(folder + "/points3D" + ending, files.points);
  }
  void WriteBinary(const ColmapContents& contents, const std::string& folder = "sparse") {
    WriteFiles(BinaryColmapFiles(contents), ".bin", folder);
  }
  void WriteImages() {
    scratch_.WriteImage("images/a b.ppm", 6, 5);
    scratch_.WriteImage("images/c.ppm", 12, 8);
    scratch_.WriteImage("images/sub/b.ppm", 12, 8);
  }
  PosedImages Read() const { return sfm::ReadColmapModel(Sparse(), scratch_.path() / "images"); }
  std::string ReadError() const {
    return InputErrorOf([&] { Read(); });
  }
  std::filesystem::path Sparse() const { return scratch_.path() / "sparse"; }

  ScratchFolder scratch_;
};

}  // namespace nerf::test
