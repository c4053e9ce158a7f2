#pragma once

#include <CLI/CLI.hpp>
#include <map>
#include <string>

namespace nerf {

// Adds a flag whose value is one of a few words; another word is an error that lists them.
template <class T>
CLI::Option* AddChoiceOption(CLI::App& command, const std::string& flag, T& value,
                             const std::map<std::string, T>& choices, const std::string& meaning) {
  std::string words;
  std::string preset;
  for (const auto& [word, choice] : choices) {
    words += (words.empty() ? "" : ", ") + word;
    if (choice == value) preset = word;
  }
  return command
      .add_option_function<std::string>(
          flag,
          [&value, choices, flag, words](const std::string& word) {
            const auto found = choices.find(word);
            if (found == choices.end()) {
              throw CLI::ValidationError(flag, word + " is not one of " + words);
            }
            value = found->second;
          },
          meaning)
      ->default_str(preset);
}

}  // namespace nerf
