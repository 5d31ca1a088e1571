#pragma once

#include <functional>
#include <map>
#include <string>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace fluxel {

/// An option --NAME whose text `parse` reads; what that throws as CLI::ValidationError is reported with the
/// name.
CLI::Option* add_parsed(CLI::App* command, const std::string& name,
                        const std::function<void(const std::string&)>& parse, const std::string& text,
                        const std::string& type);

/// For CLI::Option::check: what is wrong with a file or folder that has no name, else nothing.
[[nodiscard]] std::string refuse_empty(const std::string& path);

/// Throws CLI::ValidationError: the word is none of the choices.
[[noreturn]] void refuse_choice(const std::string& word, const std::string& choices);

/// An option --NAME that is one of the names, which must outlive the command.
template <class Value>
CLI::Option* add_choice(CLI::App* command, const std::string& name, Value& value,
                        const std::map<std::string, Value>& names, const std::string& text) {
  std::string choices;
  for (const auto& entry : names) choices += (choices.empty() ? "" : "|") + entry.first;
  return add_parsed(
      command, name,
      [&value, &names, choices](const std::string& word) {
        const auto found = names.find(word);
        if (found == names.end()) refuse_choice(word, choices);
        value = found->second;
      },
      text, choices);
}

}  // namespace fluxel
