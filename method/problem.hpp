#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/log.hpp"
#include "core/options.hpp"
#include "core/progress.hpp"
#include "mpi_master/communication/workers.hpp"
#include "mpi_master/steps/photon_job.hpp"
#include "mpi_master/steps/reference_job.hpp"
#include "mpi_master/steps/subdivision_job.hpp"
#include "reference/sensors.hpp"
#include "scene/scene.hpp"
#include "visibility/ray_scene.hpp"

namespace fluxel {

struct Options;

/// Where light is asked for.
struct SensorRequest {
  /// Elements that are given; none: a method that needs elements makes them by Options::subdivision.
  std::span<const ElementShape> elements = {};
  const Camera* camera = nullptr;  ///< of the pixels; null: there is no picture
  int supersample = 1;             ///< rays a pixel along each axis; 0: all of its area, of paths alone
  std::span<const Receiver> receivers = {};
  std::span<const Observer> observers = {};  ///< whose glare is rated

  [[nodiscard]] bool has_meters() const { return !receivers.empty() || !observers.empty(); }
};

/// What a solve is asked for: the pixels of the camera, if there is one, and the scene's meters. Options and
/// scene outlive it.
[[nodiscard]] inline SensorRequest sensors_of(const Options& options, const Scene& scene) {
  return {.camera = options.camera ? &*options.camera : nullptr,
          .supersample = options.supersample,
          .receivers = scene.receivers,
          .observers = scene.observers};
}

struct SensorLight;

/// What is shown of a solution that is not the last one, row-major; nothing is seen where all is 0.
struct EarlyPicture {
  int width = 0, height = 0;
  std::vector<Rgb> exitance, irradiance;  ///< [W/m2]
  std::vector<Rgb> reflectance;
};

/// The light of elements that an earlier run has found.
struct FinishedSolution {
  std::vector<ElementShape> elements;
  std::vector<Rgb> B;  ///< radiosity of the fronts, then, where any patch has an active back, of the backs
};

/// What the caller adds to a run while it is under way. Each may be empty.
struct ProblemHooks {
  /// On the root: the radiosity to start from, an entry an unknown of the mesh. May throw InputError.
  std::function<std::vector<Rgb>(const ElementView& mesh)> start;
  /// On the root: what is looked at. May throw InputError.
  std::function<FinishedSolution()> finished;
  /// On the root: an early radiosity, of 2^picture seconds; returns the file that shows it.
  std::function<std::string(const SubdividedScene&, std::span<const Rgb> B, std::size_t picture)>
      early_picture;
  /// On the root: a picture of a round's solution, counted from 1; returns the file.
  std::function<std::string(const EarlyPicture&, std::size_t round)> round_picture;
  /// On the root: sensors of one kind that have been measured.
  std::function<void(const SensorLight&)> measured;
  /// On the root: what photons have brought until now.
  std::function<void(const ElementView& mesh, const SensorLight&)> counted;
};

/// What photons are asked for beside sensors.
struct PhotonRequest {
  PhotonGoal goal;
  bool measures_elements = true;  ///< those of SensorRequest, else as Options::subdivision has them
  bool measures_receivers = true;
  std::filesystem::path tally;  ///< file that keeps what photons have brought
  bool resume = false;          ///< with what it has
  double keep_every = 300;      ///< [s]
  const RayScene* before =
      nullptr;  ///< the scene that the kept photons are of, to be renewed; null: this one
  std::optional<std::uint64_t> groups = {};  ///< of photons that are renewed together, at most
};

/// What any method is asked. All that it refers to outlives the solution.
struct Problem {
  const Communicator& world;
  const Scene& scene;
  const RayScene& ray_scene;
  SensorRequest sensors;
  const Options& options;  ///< the goal and the limits
  int threads = 1;         ///< of this rank
  Progress& progress;
  Log& log;
  PathGoal paths = {};
  PhotonRequest photons = {};
  ProblemHooks hooks = {};
  std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();  ///< of the run
};

[[nodiscard]] inline Workers workers_of(const Problem& problem) {
  return {problem.world, problem.threads, problem.progress};
}

}  // namespace fluxel
