#pragma once

#include <functional>
#include <map>
#include <optional>
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

/// An option --time, of wall-clock seconds.
CLI::Option* add_time(CLI::App* command, std::optional<double>& seconds, const std::string& text);

/// For CLI::Option::check: what is wrong with a file or folder that has no name, else nothing.
[[nodiscard]] std::string refuse_empty(const std::string& path);

/// Throws CLI::ValidationError: the word is none of the choices.
[[noreturn]] void refuse_choice(const std::string& word, const std::string& choices);

/// An option --NAME that is one of the names, which must outlive the command. `target` is a value of theirs,
/// or an optional one, which stays unset where the option is not given.
template <class Target, class Value>
CLI::Option* add_choice(CLI::App* command, const std::string& name, Target& target,
                        const std::map<std::string, Value>& names, const std::string& text) {
  std::string choices;
  for (const auto& entry : names) choices += (choices.empty() ? "" : "|") + entry.first;
  return add_parsed(
      command, name,
      [&target, &names, choices](const std::string& word) {
        const auto found = names.find(word);
        if (found == names.end()) refuse_choice(word, choices);
        target = found->second;
      },
      text, choices);
}

}  // namespace fluxel
