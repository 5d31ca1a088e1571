#pragma once

#include <string>
#include <variant>
#include <vector>

#include "core/options.hpp"
#include "scene/scene_input.hpp"

namespace fluxel {

/// The command line asked for a text: help or version.
struct TextRequest {
  std::string text;
};

/// `fluxel solve SCENE [options]`, with what the scene's files hold.
struct SolveRequest {
  Options options;
  SceneInput input;
  std::vector<std::string> warnings;  ///< of options that have no effect
};

/// `fluxel reference SCENE [options]`.
struct ReferenceRequest {
  ReferenceOptions options;
  SceneInput input;
};

/// `fluxel viewfactors SCENE --out F.csv [options]`.
struct ViewFactorRequest {
  ViewFactorOptions options;
  SceneInput input;
};

/// `fluxel compare A B [options]`.
struct CompareRequest {
  CompareOptions options;
};

using Request = std::variant<TextRequest, SolveRequest, ReferenceRequest, ViewFactorRequest, CompareRequest>;

/// Reads the command line (without the program's name) and the scene's files; options of a scene file stand
/// below those of the command line. Throws InputError for bad usage, for options that contradict each other
/// and for bad files.
[[nodiscard]] Request read_command_line(const std::vector<std::string>& arguments);

/// The options in force as names and texts that the command line would take as --NAME=TEXT, for reports: all
/// but the output folder and what is only told. An option that is not set is left out.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> describe(const Options& options);

}  // namespace fluxel
