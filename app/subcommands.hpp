#pragma once

#include <map>
#include <optional>
#include <string>

#include "app/choose_camera.hpp"
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

/// What all that compute light take: the scene's meaning, and what looks at it.
void declare_scene_file(CLI::App* command, std::string& scene, std::optional<double>& metres_per_unit);
void declare_scene(CLI::App* command, Options& options);
/// --live: a page of the run while it lasts.
void declare_live(CLI::App* command, Options& options);
/// What becomes of surfaces that are not diffuse: taken as black, or what the method does `otherwise`;
/// `names` must outlive the command.
void declare_specular(CLI::App* command, Specular& specular, const std::map<std::string, Specular>& names,
                      const std::string& otherwise);
void declare_camera(CLI::App* command, Options& options, CameraParts& camera);

/// How exact sensors shall become.
void declare_error_limits(CLI::App* command, ErrorLimits& limits, const std::string& group);

/// GPUs in place of processors, and how they are verified. `work`: what they do; `parts`: what of it a
/// processor does again.
void declare_device(CLI::App* command, Options& options, const std::string& work, const std::string& parts);

/// How a solve's picture is made of the light.
void declare_picture(CLI::App* command, Options& options);

/// Meshes and other files that are written where they are asked for.
void declare_meshes(CLI::App* command, Options& options);

/// Of false-colour pictures and lighting tasks.
void declare_receivers(CLI::App* command, Options& options);

void declare_solve(CLI::App* solve, SolveArguments& arguments);
void declare_view(CLI::App* view, SolveArguments& of);
/// `run` gets the scene, its options, and the target that is asked about.
void declare_info(CLI::App* info, SolveArguments& run);
void declare_compare(CLI::App* compare, CompareOptions& of);
/// `run` gets the options of the scene, the camera and the run.
void declare_reference(CLI::App* reference, SolveArguments& run, ReferenceOptions& of);
/// `run` gets the options of the scene and the run.
void declare_photons(CLI::App* photons, SolveArguments& run, PhotonOptions& of);
void declare_viewfactors(CLI::App* viewfactors, ViewFactorOptions& of);

}  // namespace fluxel
