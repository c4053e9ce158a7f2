#include "nerf/study/report.h"

#include <boost/archive/iterators/base64_from_binary.hpp>
#include <boost/archive/iterators/transform_width.hpp>

#include "nerf/base/atomic_file.h"

namespace nerf {
namespace {

namespace fs = std::filesystem;

std::string Base64(const std::string& bytes) {
  using namespace boost::archive::iterators;
  using Encoded = base64_from_binary<transform_width<std::string::const_iterator, 6, 8>>;
  std::string text(Encoded(bytes.begin()), Encoded(bytes.end()));
  while (text.size() % 4 != 0) text += '=';
  return text;
}

// JSON for embedding in a <script>: without "<", so that no name in it can end the script.
std::string ScriptOf(const nlohmann::json& json) {
  std::string text;
  const auto replace = nlohmann::json::error_handler_t::replace;
  for (const char c : json.dump(-1, ' ', false, replace)) {
    if (c == '<') {
      text += "\\u003c";
    } else {
      text += c;
    }
  }
  return text;
}

void Replace(std::string& text, std::string_view placeholder, std::string_view replacement) {
  const auto at = text.find(placeholder);
  if (at != std::string::npos) text.replace(at, placeholder.size(), replacement);
}

}  // namespace

std::string StudyReport(const nlohmann::json& results, const fs::path& crops) {
  nlohmann::json pictures = nlohmann::json::object();
  const auto add = [&](const std::string& name) {
    const fs::path file = crops / (name + ".png");
    if (!fs::exists(file)) return;
    pictures[name] = "data:image/png;base64," + Base64(ReadWholeFile(file));
  };
  add("truth");
  for (const auto& setting : results.at("settings")) add(setting.at("name"));
  std::string page(ReportTemplate());
  Replace(page, "/*CROPS*/", ScriptOf(pictures));
  Replace(page, "/*STUDY*/", ScriptOf(results));
  Replace(page, "/*CHART.JS*/", ChartLibrary());
  return page;
}

}  // namespace nerf
