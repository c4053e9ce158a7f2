#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

namespace nerf {

// A study as a page that opens in any browser without a network: PSNR against seconds of training
// and against seconds a frame with their Pareto fronts, the settings on the front, the same crop at
// rising cost, and where the time goes. Drawn by Chart.js, which is in the page.
//   results  as in study.json
//   crops    the folder of SETTING.png and truth.png
std::string StudyReport(const nlohmann::json& results, const std::filesystem::path& crops);

// Parts of the page, compiled in from report.html and Debian's libjs-chart.js.
std::string_view ReportTemplate();
std::string_view ChartLibrary();

}  // namespace nerf
