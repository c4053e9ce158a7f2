#include "nerf/base/json_fields.h"

#include <cmath>
#include <utility>

#include "nerf/base/file_bytes.h"
#include "nerf/base/input_error.h"

namespace nerf {
namespace {

bool Skip(std::string_view word, std::string_view text, std::size_t* at) {
  if (text.substr(*at, word.size()) != word) return false;
  *at += word.size();
  return true;
}

std::string WithQuotedNonFinite(std::string_view text) {
  std::string result;
  result.reserve(text.size());
  bool in_string = false;
  for (std::size_t at = 0; at < text.size();) {
    if (!in_string &&
        (Skip("NaN", text, &at) || Skip("Infinity", text, &at) || Skip("-Infinity", text, &at))) {
      result += "\"not finite\"";
      continue;
    }
    if (in_string && text[at] == '\\' && at + 1 < text.size())
      result += text[at++];
    else if (text[at] == '"')
      in_string = !in_string;
    result += text[at++];
  }
  return result;
}

// "[json.exception.parse_error.101] parse error at line 3, column 1: ..." without the bracket.
std::string Reason(const nlohmann::json::exception& error) {
  const std::string what = error.what();
  const auto bracket = what.find("] ");
  return bracket == std::string::npos ? what : what.substr(bracket + 2);
}

}  // namespace

nlohmann::json ReadJsonFile(const std::filesystem::path& file) {
  const std::string bytes = ReadFileBytes(file);
  if (bytes.starts_with("\xff\xfe") || bytes.starts_with("\xfe\xff")) {
    throw InputError("{}: is encoded in UTF-16; save it as UTF-8", file.string());
  }
  const std::string text = WithQuotedNonFinite(bytes);
  try {
    return nlohmann::json::parse(text);
  } catch (const nlohmann::json::exception& error) {
    throw InputError("{}: {}", file.string(), Reason(error));
  }
}

JsonFields::JsonFields(const nlohmann::json& object, std::string prefix)
    : object_(object), prefix_(std::move(prefix)) {
  if (!object.is_object()) {
    throw InputError("{}: must be an object {{...}}",
                     prefix_.substr(0, prefix_.find_last_not_of(".: ") + 1));
  }
}

const nlohmann::json* JsonFields::Find(std::string_view key) const {
  const auto found = object_.find(key);
  return found == object_.end() || found->is_null() ? nullptr : &*found;
}

std::optional<double> JsonFields::Number(std::string_view key) const {
  const nlohmann::json* value = Find(key);
  if (!value) return std::nullopt;
  if (!value->is_number() || !std::isfinite(value->get<double>())) {
    throw InputError("{} must be a finite number", Where(key));
  }
  return value->get<double>();
}

std::optional<bool> JsonFields::Bool(std::string_view key) const {
  const nlohmann::json* value = Find(key);
  if (!value) return std::nullopt;
  if (!value->is_boolean()) throw InputError("{} must be true or false", Where(key));
  return value->get<bool>();
}

std::optional<std::string> JsonFields::String(std::string_view key) const {
  const nlohmann::json* value = Find(key);
  if (!value) return std::nullopt;
  if (!value->is_string()) throw InputError("{} must be a string", Where(key));
  return value->get<std::string>();
}

const nlohmann::json* JsonFields::Array(std::string_view key) const {
  const nlohmann::json* value = Find(key);
  if (value && !value->is_array()) throw InputError("{} must be a list", Where(key));
  return value;
}

std::string JsonFields::Where(std::string_view key) const { return prefix_ + std::string(key); }

}  // namespace nerf
