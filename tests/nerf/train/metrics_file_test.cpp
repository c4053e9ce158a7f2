#include "nerf/train/metrics_file.h"

#include <gtest/gtest.h>

#include <fstream>

#include "nerf/base/atomic_file.h"
#include "tests/support/scratch_folder.h"

namespace nerf {
namespace {

TEST(MetricsFile, KeepsTheLinesAndTheCurveUpToTheCheckpoint) {
  const test::ScratchFolder folder;
  const auto path = folder.path() / "metrics.jsonl";
  std::ofstream(path) << R"({"step": 50, "seconds": 1.0, "validation_psnr": 20.0})"
                      << "\n"
                      << R"({"step": 100, "seconds": 2.0, "validation_psnr": 21.0})"
                      << "\n"
                      << R"({"step": 150, "seconds": 3.0, "validation_psnr": 22.0})"
                      << "\n"
                      << "{\"step\": 160, \"sec";  // power failure
  MetricsFile metrics(path, 100);
  EXPECT_EQ(metrics.Curve().Last(), 21);
  metrics.Append({{"step", 150}, {"seconds", 2.5}, {"validation_psnr", 23.0}});
  EXPECT_EQ(metrics.Curve().Last(), 23);
  const std::string text = ReadWholeFile(path);
  EXPECT_EQ(std::ranges::count(text, '\n'), 3);
  EXPECT_EQ(text.find("22.0"), std::string::npos);
}

TEST(MetricsFile, IgnoresInvalidLines) {
  const test::ScratchFolder folder;
  const auto path = folder.path() / "metrics.jsonl";
  std::ofstream(path) << "[]\n{}\n{\"step\": \"x\"}\n"
                      << R"({"step": 1, "seconds": "long", "validation_psnr": null})"
                      << "\n";
  const MetricsFile metrics(path, 10);
  EXPECT_FALSE(metrics.Curve().Last());
}

}  // namespace
}  // namespace nerf
