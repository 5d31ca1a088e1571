#include "app/option_declarations.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "app/option_values.hpp"

namespace fluxel {

CLI::Option* add_parsed(CLI::App* command, const std::string& name,
                        const std::function<void(const std::string&)>& parse, const std::string& text,
                        const std::string& type) {
  const auto read = [name, parse](const std::string& value) {
    try {
      parse(value);
    } catch (const CLI::ValidationError& error) {
      throw CLI::ValidationError("--" + name, error.what());
    }
  };
  return command->add_option_function<std::string>("--" + name, read, text)->type_name(type);
}

CLI::Option* add_time(CLI::App* command, std::optional<double>& seconds, const std::string& text) {
  return add_parsed(
      command, "time", [&seconds](const std::string& t) { seconds = parse_number(t); }, text, "SECONDS");
}

std::string refuse_empty(const std::string& path) {
  return path.empty() ? "needs the name of a file or folder, not an empty one" : "";
}

void refuse_choice(const std::string& word, const std::string& choices) {
  throw CLI::ValidationError(fmt::format("'{}' is none of {}", word, choices));
}

}  // namespace fluxel
