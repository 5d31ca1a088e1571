#include "app/help_text.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <string_view>

#include "method/methods.hpp"

namespace fluxel {

namespace {

/// Of `fluxel solve`, what the help shows without --help-all.
constexpr std::array<std::string_view, 18> kFirstOptions{
    "help",   "help-all",   "out",      "target-error", "method",          "eye", "look-at", "up",
    "fov",    "resolution", "exposure", "sides",        "metres-per-unit", "ke",  "thermal", "threads",
    "memory", "checkpoint"};

constexpr std::string_view kExamples =
    "  fluxel solve room.obj --eye 1,1.6,4 --look-at 1,1.5,0      a picture within 1 % of the truth\n"
    "  fluxel solve room.obj --target-error 0.05 --eye ...        a quick one, within 5 %\n"
    "  mpirun -np 4 fluxel solve hall.toml --out hall             on four ranks, the same result\n";

/// Hides what comes second.
void keep_first_options(CLI::App& solve) {
  for (CLI::Option* option : solve.get_options()) {
    if (option->get_lnames().empty()) continue;  // the scene
    const std::string& name = option->get_lnames().front();
    if (std::ranges::find(kFirstOptions, name) == kFirstOptions.end()) option->group("");
  }
}

std::string methods_text() {
  std::string text = "Methods:\n";
  for (const MethodRow& row : kMethods)
    if (row.command == "solve") text += fmt::format("  {:13} {}\n", row.name, row.sentence);
  return text;
}

/// One empty line between groups, where CLI11 leaves two.
std::string close_up(std::string text) {
  constexpr std::string_view kGap = "\n\n\n";
  for (std::size_t at = 0; (at = text.find(kGap, at)) != std::string::npos;) text.erase(at, 1);
  return text;
}

}  // namespace

std::string help_text(CLI::App& of, bool all) {
  const std::string program = of.get_parent() != nullptr ? "fluxel" : "";
  if (of.get_name() != "solve") return close_up(of.help(program));
  if (!all) keep_first_options(of);
  return close_up(of.help(program)) + methods_text() +
         (all ? "" : fmt::format("\nExamples:\n{}\nAll options: fluxel solve --help-all\n", kExamples));
}

}  // namespace fluxel
