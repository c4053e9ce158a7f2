#pragma once

#include <gtest/gtest.h>
#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>

#include <filesystem>
#include <memory>
#include <sstream>
#include <string>

#include "sfm/colmap_runner.h"
#include "tests/support/fake_colmap.h"
#include "tests/support/input_error_of.h"
#include "tests/support/photo_files.h"
#include "tests/support/scratch_folder.h"

namespace nerf::test {

// Captures log messages.
class LogText {
 public:
  LogText() : before_(spdlog::default_logger()) {
    spdlog::set_default_logger(std::make_shared<spdlog::logger>(
        "test", std::make_shared<spdlog::sinks::ostream_sink_mt>(text_)));
  }
  ~LogText() { spdlog::set_default_logger(before_); }
  std::string Text() const { return text_.str(); }

 private:
  std::shared_ptr<spdlog::logger> before_;
  std::ostringstream text_;
};

// A run of sfm::PosesFromPhotos with FakeColmap.
class ColmapRun : public testing::Test {
 protected:
  void WritePhotos(int count) const {
    for (int i = 0; i < count; ++i) {
      WritePhoto(photos_.path() / fmt::format("p{:03}.png", i), 64, 48);
    }
  }
  PosedImages Run() {
    report_ = {};
    return sfm::PosesFromPhotos(photos_.path(), Workspace(), options_, &report_);
  }
  std::string Error() {
    return InputErrorOf([&] { Run(); });
  }
  std::filesystem::path Workspace() const { return out_.path() / "colmap"; }

  FakeColmap fake_;
  ScratchFolder photos_;
  ScratchFolder out_;
  LogText log_;
  sfm::ColmapOptions options_;
  sfm::ColmapReport report_;
};

}  // namespace nerf::test
