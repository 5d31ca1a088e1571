#include "app/help_text.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <string>
#include <string_view>

#include "app/terminal.hpp"
#include "core/options.hpp"
#include "method/methods.hpp"

namespace fluxel {

namespace {

struct CommandHelp {
  std::string_view command;
  /// What the help shows without --help-all, by the first of its long names, a blank behind each; empty:
  /// everything.
  std::string_view first_options;
  std::string_view examples;
};

/// A row for each sub-command.
constexpr std::array kHelp{
    CommandHelp{
        "solve",
        "help help-all out target-error method eye look-at up fov resolution sides metres-per-unit "
        "thermal threads write dry-run ",
        "  fluxel solve room.obj --eye 1,1.6,4 --look-at 1,1.5,0      a picture within 1 % of the truth\n"
        "  fluxel solve room.obj --target-error 0.05                  the light on all surfaces, within 5 %\n"
        "  mpirun -np 2 fluxel solve room.toml --out room             on two ranks, the same result\n"},
    CommandHelp{
        "reference",
        "help help-all elements only target-error time out eye look-at up fov resolution sides "
        "metres-per-unit threads ",
        "  fluxel reference room.toml --only picture --target-error 0.05      the picture, by paths of "
        "light\n"
        "  fluxel reference room.toml --elements out/solution.ply --time 60   the elements of a solve\n"},
    CommandHelp{"photons",
                "help help-all max-edge elements only sequence target-error time photons resume out sides "
                "metres-per-unit threads ",
                "  fluxel photons room.toml --max-edge 0.25 --target-error 0.05\n"
                "  fluxel photons room.toml --max-edge 0.25 --target-error 0.02 --resume     more of them\n"},
    CommandHelp{"view",
                "help help-all solution target-error out write eye look-at up fov resolution exposure sides "
                "metres-per-unit threads ",
                "  fluxel view room.toml --solution out/solution.ply --eye 3,1.6,2 --look-at 0,1,0\n"},
    CommandHelp{"viewfactors", "",
                "  fluxel viewfactors room.obj --out factors                        between groups\n"
                "  fluxel viewfactors room.obj --keep-polygons --write mtx          between faces, too\n"},
    CommandHelp{"info", "", "  fluxel info room.obj --metres-per-unit 0.001     a model in millimetres\n"},
    CommandHelp{"compare", "",
                "  fluxel compare out/image.exr reference/reference.exr --out errors\n"
                "  fluxel compare out/solution.ply reference/reference.ply --fail-above 0.02\n"},
};

/// Hides what comes second.
void keep_first_options(CLI::App& command, const CommandHelp& help) {
  for (CLI::Option* option : command.get_options()) {
    if (option->get_lnames().empty()) continue;  // the scene
    const std::string& name = option->get_lnames().front();
    if ((" " + std::string(help.first_options)).find(" " + name + " ") == std::string::npos)
      option->group("");
  }
}

std::string methods_text() {
  std::string text = "Methods:\n";
  for (const MethodRow& row : kMethods)
    if (row.command == "solve") text += fmt::format("  {:13} {}\n", row.name, row.sentence);
  return text + "\n";
}

/// One empty line between groups, where CLI11 leaves two.
std::string close_up(std::string text) {
  constexpr std::string_view kGap = "\n\n\n";
  for (std::size_t at = 0; (at = text.find(kGap, at)) != std::string::npos;) text.erase(at, 1);
  return text;
}

std::string help_of_command(CLI::App& of, const CommandHelp& help, bool all) {
  const bool shortened = !all && !help.first_options.empty();
  if (shortened) keep_first_options(of, help);
  std::string text = close_up(of.help("fluxel"));
  if (of.get_name() == "solve") text += methods_text();
  text += fmt::format("Examples:\n{}", help.examples);
  if (shortened) text += fmt::format("\nAll options: fluxel {} --help-all\n", of.get_name());
  return text;
}

}  // namespace

std::string help_text(CLI::App& of, bool all) {
  const auto* const help = std::ranges::find(kHelp, std::string_view(of.get_name()), &CommandHelp::command);
  const std::string text = help == kHelp.end()
                               ? close_up(of.help() + "\nHelp of a command: fluxel COMMAND --help\n")
                               : help_of_command(of, *help, all);
  return wrapped(text, text_columns());
}

}  // namespace fluxel
