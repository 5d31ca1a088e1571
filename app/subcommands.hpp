#pragma once

#include "app/option_checks.hpp"
#include "core/options.hpp"

namespace CLI {
class App;
}

namespace fluxel {

// The arguments of each sub-command, declared once. What they are read into must outlive the command.

/// What `fluxel solve` takes.
struct SolveArguments {
  Options options;
  CameraParts camera;
};

void declare_solve(CLI::App* solve, SolveArguments& arguments);
void declare_viewfactors(CLI::App* viewfactors, ViewFactorOptions& of);

}  // namespace fluxel
