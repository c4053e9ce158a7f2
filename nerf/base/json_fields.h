#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

namespace nerf {

// Parses a JSON file in UTF-8. NaN and Infinity, which Python writes although JSON has neither, are
// read as these words, so that the error about them can name the key. Throws InputError naming the
// file, line and column.
nlohmann::json ReadJsonFile(const std::filesystem::path& file);

// Looks keys up in one object of a JSON file. A key whose value is null counts as absent. Every
// getter throws InputError with file, place and key when the value has another type; numbers must
// be finite.
class JsonFields {
 public:
  // Keeps a reference to `object`. Throws InputError when it is not an object.
  //   prefix  put before a key in messages: "transforms.json: ", "transforms.json: frames[3]."
  JsonFields(const nlohmann::json& object, std::string prefix);

  bool Has(std::string_view key) const { return Find(key) != nullptr; }
  std::optional<double> Number(std::string_view key) const;
  std::optional<bool> Bool(std::string_view key) const;
  std::optional<std::string> String(std::string_view key) const;
  // nullptr where the key is absent.
  const nlohmann::json* Array(std::string_view key) const;

  // "transforms.json: frames[3].fl_x"
  std::string Where(std::string_view key) const;

 private:
  const nlohmann::json* Find(std::string_view key) const;

  const nlohmann::json& object_;
  std::string prefix_;
};

}  // namespace nerf
