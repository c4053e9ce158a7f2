#pragma once

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "sfm/transforms_json.h"
#include "tests/support/input_error_of.h"
#include "tests/support/scratch_folder.h"

namespace nerf::test {

inline const nlohmann::json kIdentity = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};

inline nlohmann::json Frame(const std::string& file_path) {
  return {{"file_path", file_path}, {"transform_matrix", kIdentity}};
}

// Two frames of 20x10 pixels.
inline nlohmann::json TwoFrames() {
  return {{"fl_x", 30},
          {"fl_y", 31},
          {"w", 20},
          {"h", 10.0},
          {"frames", {Frame("images/b.ppm"), Frame("./images/a.ppm")}}};
}

class TransformsJson : public testing::Test {
 protected:
  TransformsJson() {
    scratch_.WriteImage("images/a.ppm", 20, 10);
    scratch_.WriteImage("images/b.ppm", 20, 10);
  }
  PosedImages Read(const std::string& text) {
    return sfm::ReadTransformsJson(scratch_.Write("transforms.json", text));
  }
  PosedImages Read(const nlohmann::json& root) { return Read(root.dump()); }
  // Accepts text or JSON.
  template <class T>
  std::string ReadError(const T& contents) {
    return InputErrorOf([&] { Read(contents); });
  }
  Camera ReadCamera(const nlohmann::json& keys) {
    nlohmann::json root = TwoFrames();
    root.update(keys);
    const PosedImages posed = Read(root);
    EXPECT_EQ(posed.cameras.size(), 1u);
    return posed.cameras.at(0);
  }
  ScratchFolder scratch_;
};

}  // namespace nerf::test
