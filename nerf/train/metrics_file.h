#pragma once

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "nerf/train/quality_curve.h"

namespace nerf {

// metrics.jsonl of a run: one line, a JSON object, per validation.
class MetricsFile {
 public:
  // Keeps existing lines up to and including `last_step`. Lines after the checkpoint from which a
  // run resumes are discarded, as they will be written again.
  MetricsFile(const std::filesystem::path& path, std::int64_t last_step);

  void Append(const nlohmann::json& line);

  // "validation_psnr" over "seconds" of all lines.
  const QualityCurve& Curve() const { return curve_; }

 private:
  void AddToCurve(const nlohmann::json& line);

  std::ofstream file_;
  QualityCurve curve_;
};

}  // namespace nerf
