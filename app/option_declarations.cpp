#include "app/option_declarations.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

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

std::string refuse_empty(const std::string& path) {
  return path.empty() ? "needs the name of a file or folder, not an empty one" : "";
}

void refuse_choice(const std::string& word, const std::string& choices) {
  throw CLI::ValidationError(fmt::format("'{}' is none of {}", word, choices));
}

}  // namespace fluxel
