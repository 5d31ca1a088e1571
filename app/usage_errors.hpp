#pragma once

#include <string>

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace fluxel {

/// "unknown command 'sovle': did you mean 'solve'?"; the question only where a command of the program is
/// spelled almost so.
[[nodiscard]] std::string unknown_command(const CLI::App& program, const std::string& word);

/// What a parse of the command has met. Of an unknown option: "unknown option '--sovler': did you mean
/// '--solver'?".
[[nodiscard]] std::string usage_sentence(const CLI::ParseError& error, const CLI::App& command);

}  // namespace fluxel
