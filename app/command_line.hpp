#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/options.hpp"
#include "scene/scene_input.hpp"

namespace fluxel {

/// `fluxel solve SCENE [options]` or `fluxel view SCENE --solution FILE [options]`, with what the scene's
/// files hold.
struct SolveRequest {
  Options options;
  SceneInput input;
  std::vector<std::string> warnings;  ///< of options that have no effect
};

/// `fluxel reference SCENE [options]`.
struct ReferenceRequest {
  ReferenceOptions options;
  SceneInput input;
  std::vector<std::string> warnings;  ///< as of a solve
};

/// `fluxel photons SCENE [options]`.
struct PhotonsRequest {
  PhotonOptions options;
  SceneInput input;
  std::optional<SceneInput> before;   ///< of --changed-from
  std::vector<std::string> warnings;  ///< as of a solve
};

/// `fluxel viewfactors SCENE --out DIR [options]`.
struct ViewFactorRequest {
  ViewFactorOptions options;
  SceneInput input;
};

/// `fluxel info SCENE [options]`.
struct InfoRequest {
  Options options;
  SceneInput input;
};

/// `fluxel compare A B [options]`.
struct CompareRequest {
  CompareOptions options;
};

using Request = std::variant<SolveRequest, ReferenceRequest, PhotonsRequest, ViewFactorRequest, InfoRequest,
                             CompareRequest>;

/// The help or the version, where the command line (without the program's name) asks for one: `--help`,
/// `--help-all`, `help COMMAND`, `--version`. Reads no file.
[[nodiscard]] std::optional<std::string> text_asked_for(const std::vector<std::string>& arguments);

/// Reads the command line (without the program's name) and the scene's files; options of a scene file stand
/// below those of the command line. Throws InputError for bad usage, for options that contradict each other
/// and for bad files.
[[nodiscard]] Request read_command_line(const std::vector<std::string>& arguments);

}  // namespace fluxel
