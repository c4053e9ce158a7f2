#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

namespace nerf {

// A study as an HTML page that needs no network: PSNR over training time and over time per frame
// with their Pareto fronts, the settings on the front, the same crop at increasing cost, and the
// time of each stage. Drawn by Chart.js, which is embedded in the page.
//   results  as in study.json
//   crops    folder of SETTING.png and truth.png
std::string StudyReport(const nlohmann::json& results, const std::filesystem::path& crops);

// Parts of the page, compiled into the program: report.html, and Debian's libjs-chart.js.
std::string_view ReportTemplate();
std::string_view ChartLibrary();

}  // namespace nerf
