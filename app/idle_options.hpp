#pragma once

#include <string>
#include <vector>

#include "scene/input_camera.hpp"

namespace CLI {
class App;
}  // namespace CLI

namespace fluxel {

struct Options;
struct ReferenceOptions;
struct PhotonOptions;

/// A sentence for each option that `solve` was given and that has no effect beside the others.
[[nodiscard]] std::vector<std::string> warn_of_idle_options(const CLI::App& solve, const Options& options,
                                                            const InputCamera& camera);
/// The same of `reference`, of what its command line gives.
[[nodiscard]] std::vector<std::string> warn_of_idle_options(const CLI::App& reference,
                                                            const ReferenceOptions& options);
/// And of `photons`.
[[nodiscard]] std::vector<std::string> warn_of_idle_options(const CLI::App& photons,
                                                            const PhotonOptions& options);

}  // namespace fluxel
