#include "app/usage_errors.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <vector>

#include "core/nearest_name.hpp"

namespace fluxel {

namespace {

std::string question(const std::string& nearest, const char* dashes) {
  return nearest.empty() ? "" : fmt::format(": did you mean '{}{}'?", dashes, nearest);
}

}  // namespace

std::string unknown_command(const CLI::App& program, const std::string& word) {
  std::vector<std::string> names;
  for (const CLI::App* command : program.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(command->get_name());
  return fmt::format("unknown command '{}'{}", word, question(nearest_name(word, names), ""));
}

std::string usage_sentence(const CLI::ParseError& error, const CLI::App& command) {
  // What is left over may also be the value of an option that is unknown.
  const std::vector<std::string> left = command.remaining();
  const auto option =
      std::ranges::find_if(left, [](const std::string& word) { return word.starts_with('-'); });
  if (dynamic_cast<const CLI::ExtrasError*>(&error) == nullptr || option == left.end()) return error.what();
  const std::string given = option->substr(0, option->find('='));
  std::vector<std::string> names;
  for (const CLI::Option* known : command.get_options())
    for (const std::string& name : known->get_lnames()) names.push_back(name);
  const std::string word = given.substr(std::min(given.find_first_not_of('-'), given.size()));
  return fmt::format("unknown option '{}'{}", given, question(nearest_name(word, names), "--"));
}

}  // namespace fluxel
