#pragma once

#include <string>

namespace CLI {
class App;
}

namespace fluxel {

/// The help of the program or of one of its commands, examples at its end. Unless `all` is asked for, what a
/// user needs first, on one screen.
[[nodiscard]] std::string help_text(CLI::App& of, bool all);

}  // namespace fluxel
