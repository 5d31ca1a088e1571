#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/camera.hpp"
#include "core/choices.hpp"
#include "mpi_master/communication/communicator.hpp"
#include "mpi_master/steps/form_factor_matrix.hpp"
#include "mpi_master/steps/visibility_job.hpp"
#include "scene/scene_input.hpp"
#include "solver/iterate.hpp"

/// The stability lab: every method on every situation in which some method fails.
namespace fluxel::lab {

/// A way to solve, as the command line offers it.
struct Method {
  std::string name;
  FormFactorOptions form_factor;
  Solver solver = Solver::jacobi;
};

/// All methods that the lab compares; what comes later is one line here.
[[nodiscard]] std::vector<Method> methods();

/// The method of that name. Throws std::out_of_range.
[[nodiscard]] Method method_named(const std::string& name);

/// A scene made by hand, and how it is run.
struct Setup {
  SceneInput input;
  Sides sides = Sides::one;
  bool cut = true;
  Subdivision subdivision = Subdivision::none;
  double max_edge = 0;  ///< [m], with Subdivision::uniform
  std::optional<Camera> camera;
  StopRule stop{1e-6, 20000};
  /// Changes rho and E of the unknowns before the solve, where materials cannot say it.
  std::function<void(const ElementMesh&, Unknowns&)> adjust;
};

/// The first two steps of it. Throws InputError as build_scene does.
[[nodiscard]] Scene build(const Setup& setup);
[[nodiscard]] ElementMesh subdivide(const Communicator& world, const Setup& setup, const Scene& scene);

/// A setup up to its matrix, ready for any number of solves.
struct Prepared {
  Scene scene;
  ElementMesh mesh;
  Unknowns unknowns;
  RayScene ray_scene;
  Visibility visibility;
  std::vector<SideView> views;
  FormFactorMatrix matrix;

  /// The main path of `fluxel solve`, without files. Throws InputError as build_scene does.
  Prepared(const Communicator& world, const Setup& setup, const FormFactorOptions& form_factor);
  Prepared(const Prepared&) = delete;  // the later members refer to the earlier ones
  Prepared& operator=(const Prepared&) = delete;
};

/// What a run has shown.
struct Run {
  Scene scene;
  ElementMesh mesh;
  Unknowns unknowns;
  Radiosity radiosity;
  FormFactorStatistics form_factors;
  std::vector<SideView> views;
  std::vector<double> row_sums;  ///< of the matrix as it is solved

  /// Area-weighted mean of H or B of the fronts of a group, first channel.
  [[nodiscard]] double mean_H(const std::string& group) const;
  [[nodiscard]] double mean_B(const std::string& group) const;
};

/// Prepares and solves. Throws InputError as build_scene does.
[[nodiscard]] Run run(const Communicator& world, const Setup& setup, const Method& method);

/// A polygon of a group; materials and groups are added to the input by name as they come.
void add_polygon(SceneInput& input, const std::string& group, double rho, double E,
                 const std::vector<glm::dvec3>& corners);

/// What is read off one run: the error that the situation is about, against the exact value or the physical
/// limit; infinite where the solution diverges.
struct Measurement {
  double error = 0;
  bool converged = true;
};

/// One row of the failure table: a parameter is driven to where methods fail.
struct Situation {
  std::string name;       ///< file-name safe, as "edge-contact"
  std::string title;      ///< of the chart
  std::string parameter;  ///< axis label with unit
  std::string error;      ///< axis label: what is measured
  double threshold = 0;   ///< errors up to this are safe
  bool log_parameter = true;
  std::vector<double> values;         ///< of the parameter
  std::vector<double> coarse_values;  ///< few and quick, for the regression tests
  std::function<Measurement(const Communicator&, const Method&, double value)> measure;
};

/// All situations, in the order of the table in bench/results/stability.md.
[[nodiscard]] std::vector<Situation> situations();

}  // namespace fluxel::lab
