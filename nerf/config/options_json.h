#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "nerf/base/input_error.h"
#include "nerf/base/options.h"

namespace nerf {

// Visitors of option blocks (nerf/base/options.h): conversion to JSON and back, range checks, and
// the help table.

template <HasOptions T>
nlohmann::json JsonFromOptions(const T& options);

// Reads a document that contains every key with the right kind of value.
//   path  prefix of the block's keys in errors, such as "march."
// Throws InputError naming the key of an unknown enumerator.
template <HasOptions T>
void OptionsFromJson(const nlohmann::json& json, const std::string& path, T& options);

// Throws InputError naming the first key whose value is out of its range.
template <HasOptions T>
void CheckRanges(const T& options, const std::string& path);

// A row of the help table.
struct OptionHelp {
  std::string key;    // "march.near_distance"
  std::string value;  // its default, as JSON
  std::string unit, range, help;
};
// Appends every key of a block and of its nested blocks, including optional blocks that are null.
template <HasOptions T>
void DescribeOptions(const T& options, const std::string& path, std::vector<OptionHelp>& table);

// ---------------------------------------------------------------------------------------------

namespace internal {

template <class T>
std::string NamesOf() {
  std::string names;
  for (const auto& [value, name] : EnumNames<T>::kNames) {
    names += (names.empty() ? "" : ", ") + std::string(name);
  }
  return names;
}

struct JsonWriter {
  nlohmann::json& json;

  template <class T>
  void operator()(const char* name, const T& number, const char*, const Range&, const char*) const {
    json[name] = number;
  }
  template <class T>
  void operator()(const char* name, const T& value, const char*) const {
    if constexpr (std::is_enum_v<T>) {
      json[name] = std::string(NameOf(value));
    } else {
      json[name] = JsonFromOptions(value);
    }
  }
  template <class T>
  void operator()(const char* name, const std::optional<T>& block, const char*) const {
    json[name] = block ? JsonFromOptions(*block) : nlohmann::json();
  }
};

struct JsonReader {
  const nlohmann::json& json;
  std::string path;

  template <class T>
  void operator()(const char* name, T& number, const char*, const Range&, const char*) const {
    json.at(name).get_to(number);
  }
  template <class T>
  void operator()(const char* name, T& value, const char*) const {
    if constexpr (std::is_enum_v<T>) {
      const std::string text = json.at(name);
      for (const auto& [known, known_name] : EnumNames<T>::kNames) {
        if (text != known_name) continue;
        value = known;
        return;
      }
      throw InputError("config: {}{} is \"{}\"; use one of {}", path, name, text, NamesOf<T>());
    } else {
      OptionsFromJson(json.at(name), path + name + ".", value);
    }
  }
  template <class T>
  void operator()(const char* name, std::optional<T>& block, const char*) const {
    block.reset();
    if (!json.at(name).is_null())
      OptionsFromJson(json.at(name), path + name + ".", block.emplace());
  }
};

struct RangeChecker {
  std::string path;

  template <class T>
  void operator()(const char* name, const T& number, const char* unit, const Range& range,
                  const char*) const {
    if (range.Contains(static_cast<double>(number))) return;
    throw InputError("config: {}{} is {}; use {}{}{}", path, name, number, range.Text(),
                     *unit ? " " : "", unit);
  }
  template <class T>
  void operator()(const char* name, const T& value, const char*) const {
    if constexpr (!std::is_enum_v<T>) CheckRanges(value, path + name + ".");
  }
  template <class T>
  void operator()(const char* name, const std::optional<T>& block, const char*) const {
    if (block) CheckRanges(*block, path + name + ".");
  }
};

struct Describer {
  std::string path;
  std::vector<OptionHelp>& table;

  template <class T>
  void operator()(const char* name, const T& number, const char* unit, const Range& range,
                  const char* help) const {
    table.push_back({path + name, nlohmann::json(number).dump(), unit, range.Text(), help});
  }
  template <class T>
  void operator()(const char* name, const T& value, const char* help) const {
    if constexpr (std::is_enum_v<T>) {
      table.push_back({path + name, std::string(NameOf(value)), "", NamesOf<T>(), help});
    } else {
      DescribeOptions(value, path + name + ".", table);
    }
  }
  template <class T>
  void operator()(const char* name, const std::optional<T>& block, const char* help) const {
    table.push_back({path + name, block ? "{}" : "null", "", "{...} or null", help});
    DescribeOptions(block.value_or(T()), path + name + ".", table);
  }
};

}  // namespace internal

template <HasOptions T>
nlohmann::json JsonFromOptions(const T& options) {
  nlohmann::json json = nlohmann::json::object();
  T::Options(options, internal::JsonWriter{json});
  return json;
}

template <HasOptions T>
void OptionsFromJson(const nlohmann::json& json, const std::string& path, T& options) {
  T::Options(options, internal::JsonReader{json, path});
}

template <HasOptions T>
void CheckRanges(const T& options, const std::string& path) {
  T::Options(options, internal::RangeChecker{path});
}

template <HasOptions T>
void DescribeOptions(const T& options, const std::string& path, std::vector<OptionHelp>& table) {
  T::Options(options, internal::Describer{path, table});
}

}  // namespace nerf
