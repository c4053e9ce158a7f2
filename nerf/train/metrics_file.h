#pragma once

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "nerf/train/quality_curve.h"

namespace nerf {

// metrics.jsonl of a run: a JSON object a line, a line each validation.
class MetricsFile {
 public:
  // Keeps the lines up to and with `last_step`: what a run wrote after the checkpoint that it
  // resumes from will be written again.
  MetricsFile(const std::filesystem::path& path, std::int64_t last_step);

  void Append(const nlohmann::json& line);

  // Of "validation_psnr" against "seconds", of all lines so far.
  const QualityCurve& Curve() const { return curve_; }

 private:
  void AddToCurve(const nlohmann::json& line);

  std::ofstream file_;
  QualityCurve curve_;
};

}  // namespace nerf
