#include "nerf/train/metrics_file.h"

#include <cmath>
#include <string>

#include "nerf/base/atomic_file.h"

namespace nerf {

MetricsFile::MetricsFile(const std::filesystem::path& path, std::int64_t last_step) {
  std::string kept;
  {
    std::ifstream file(path);
    for (std::string line; std::getline(file, line);) {
      const auto json = nlohmann::json::parse(line, nullptr, /*allow_exceptions=*/false);
      if (!json.is_object() || !json.contains("step") || !json["step"].is_number() ||
          json["step"] > last_step) {
        continue;
      }
      kept += line + "\n";
      AddToCurve(json);
    }
  }
  WriteFileAtomically(path, kept);
  file_.open(path, std::ios::app);
}

void MetricsFile::Append(const nlohmann::json& line) {
  file_ << line.dump() << "\n" << std::flush;
  AddToCurve(line);
}

void MetricsFile::AddToCurve(const nlohmann::json& line) {
  const auto number = [&line](const char* key) {
    const auto found = line.find(key);
    return found != line.end() && found->is_number() ? found->get<double>() : std::nan("");
  };
  curve_.Add(number("seconds"), number("validation_psnr"));
}

}  // namespace nerf
