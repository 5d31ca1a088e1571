#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/choices.hpp"
#include "core/edge_pixel.hpp"
#include "core/option_names.hpp"
#include "method/audit.hpp"
#include "method/baked_mesh.hpp"
#include "method/energy.hpp"
#include "method/hierarchy_statistics.hpp"
#include "method/light_map.hpp"
#include "method/matrix_heat.hpp"
#include "method/matrix_statistics.hpp"
#include "method/stopwatch.hpp"
#include "method/thermal.hpp"
#include "metrics/glare_rating.hpp"
#include "mpi_master/checkpoint/checkpoint.hpp"
#include "mpi_master/steps/photon_job.hpp"
#include "mpi_master/steps/reference_job.hpp"
#include "mpi_master/steps/renewal_job.hpp"
#include "mpi_master/steps/subdivision_job.hpp"
#include "solver/error_bound.hpp"
#include "solver/iterate.hpp"
#include "solver/refinement_error.hpp"

namespace fluxel {

/// What the phases of a run took.
struct PhaseTimes {
  PhaseTime load, subdivision, forecast, visibility, form_factors, preview, solve, energy, gather, image,
      estimate, audit, total;
};

struct NamedPhase {
  std::string_view name;
  PhaseTime PhaseTimes::*time;
};

/// In the order of a run, under their names in reports.
inline constexpr std::array kPhases{NamedPhase{"load", &PhaseTimes::load},
                                    NamedPhase{"subdivision", &PhaseTimes::subdivision},
                                    NamedPhase{"forecast", &PhaseTimes::forecast},
                                    NamedPhase{"visibility", &PhaseTimes::visibility},
                                    NamedPhase{"form_factors", &PhaseTimes::form_factors},
                                    NamedPhase{"preview", &PhaseTimes::preview},
                                    NamedPhase{"solve", &PhaseTimes::solve},
                                    NamedPhase{"energy", &PhaseTimes::energy},
                                    NamedPhase{"gather", &PhaseTimes::gather},
                                    NamedPhase{"image", &PhaseTimes::image},
                                    NamedPhase{"estimate", &PhaseTimes::estimate},
                                    NamedPhase{"audit", &PhaseTimes::audit},
                                    NamedPhase{"total", &PhaseTimes::total}};

/// How far the solution is from the true radiosity, as coarser meshes tell.
struct ErrorEstimate {
  std::string why_none;               ///< empty: there is one
  bool elements_too_large = false;    ///< there is none, since the run's own elements are
  std::vector<std::size_t> elements;  ///< of the run's mesh and of those coarser than it
  RefinementError discretisation;
};

/// The radiosity of a mesh of unions of the next finer mesh's elements.
struct CoarserSolution {
  std::vector<std::uint32_t> first;  ///< finer element of each, and the number of finer elements at the end
  bool converged = false;            ///< else there is nothing of what follows; on all ranks
  std::vector<double> area = {};     ///< of each unknown, 0 where a side is none [m2]
  std::vector<Rgb> B = {}, H = {};   ///< of each unknown, on leaders [W/m2]
  Rgb error{0};                      ///< bound for the root mean square over the area-mean
};

/// The finest first.
using CoarserSolutions = std::vector<CoarserSolution>;

/// How the pixels of a picture have come to their light.
struct PictureStatistics {
  std::size_t records = 0;      ///< that light was interpolated between; 0: every pixel was gathered
  std::size_t single = 0;       ///< pixels beside them that were gathered each on its own
  std::optional<double> error;  ///< of the gather, root mean square over the mean, where that is known
  double ray_error = 0;         ///< see GatherGoal
};

/// What photons have come to, and how.
struct PhotonStatistics {
  std::uint64_t sent = 0;      ///< of all jobs
  std::uint64_t restored = 0;  ///< of earlier jobs
  std::uint64_t rays = 0, coordinates = 0;
  double power = 0;                      ///< of all together, the mean of the channels [W] or [lm]
  Rgb absorbed{0}, escaped{0}, lost{0};  ///< [W] or [lm]
  std::string ending;                    ///< why no more were sent, a sentence
  std::vector<PhotonTurn> turns;
  std::optional<RenewalResult> renewal;  ///< where photons have been renewed after a change
  std::string unkept;  ///< why the tally could not be written at the end; empty: it was, on the root
};

/// Light at the sensors of one kind; estimates on the root.
struct SensorLight {
  Measured kind = Measured::receivers;
  std::string receiver;       ///< whose cells they are; empty of elements and pixels
  int columns = 0, rows = 0;  ///< of pixels and cells, row 0 at the top; of elements 0
  ReferenceResult measured;
  bool knows_each_error = true;            ///< of single sensors; else their halves tell of all together
  std::vector<SensorEstimate> irradiance;  ///< of elements that photons have come to [W/m2]; else empty
  double seconds = 0;

  /// What a run calls them: elements, picture, or "receiver" and its name.
  [[nodiscard]] std::string name() const {
    return kind == Measured::receivers ? "receiver " + receiver : name_of(kMeasuredNames, kind);
  }
};

/// What an observer's eye gets, of the luminance of colours [cd/m2, lx and the like].
struct ObserverGlare {
  std::string observer;
  GlareSources sources;
  /// Irradiance at right angles to the line of sight of what surfaces scatter, and its standard error.
  double indirect = 0, indirect_error = 0;
  bool reached = true;  ///< the error that was asked for
};

/// GPUs that have followed paths of light or found what rays meet, of all ranks.
struct RayDeviceStatistics {
  int ranks = 0;                   ///< that have one
  std::vector<std::string> names;  ///< different ones, on the root
  VerifiedCounts counts;
};

/// How far a run came.
enum class RunEnd { forecast, visibility, solution };

/// What a method has found. What it did not come to, or does not have, stays unset. Of matrices radiosity,
/// energy and row sums are the leaders', of hierarchies energy, heat and row sums are the root's, and so is
/// the radiosity of their own leaves; the rest is on all ranks unless it says otherwise.
struct Solution {
  RunEnd end = RunEnd::solution;

  SubdividedScene subdivided;          ///< the elements, and which of them the pixels see
  std::optional<Radiosity> radiosity;  ///< of the unknowns, with the iteration's bounds
  bool converged = false;              ///< on all ranks
  bool goal_reached = true;            ///< the error that was asked for, within the limits of memory and time
  bool stopped = false;                ///< by a signal; what there is is whole
  std::vector<Rgb> pixel_irradiance;   ///< of each pixel on its own; empty: pixels show their elements
  std::optional<PictureStatistics> picture;  ///< of that
  std::vector<EdgePixel> edges;              ///< pixels in which surfaces meet, by their area; on the root
  std::optional<BakedMesh> mesh;             ///< that is written in place of the elements; on the root
  std::optional<LightMap> light_map;         ///< on the root
  std::vector<SensorLight> sensors;          ///< what was measured or gathered apart from the unknowns
  std::vector<ObserverGlare> glare;          ///< of the scene's observers; on the root

  CoarserSolutions coarser;                     ///< of meshes that were solved before the run's own
  std::optional<ErrorEstimate> error_estimate;  ///< on the root
  /// Of the unknowns' radiosity, root mean square over the mean, as far as the method can tell; on the root.
  std::optional<double> expected_error;
  /// Of the picture, or of what --error-of names: that is below it with a chance of nine in ten; on the root.
  std::optional<double> stated_error;
  std::optional<Audit> audit;  ///< where the error was measured
  std::optional<EnergyBalance> energy;
  RowSums row_sums;            ///< of the system as it is solved
  std::optional<bool> closed;  ///< no ray escapes from any unknown side
  std::vector<ThermalRow> thermal;
  std::optional<HeatSteps> heat_steps;  ///< where faces have convection

  std::optional<MatrixStatistics> matrix;
  std::optional<FormFactorSums> form_factor_sums;
  std::optional<HierarchyStatistics> hierarchy;
  std::optional<CheckpointCounts> checkpoint;
  std::optional<PhotonStatistics> photons;
  std::optional<RayDeviceStatistics> ray_devices;  ///< where any rank has one
  std::string solver_reason;                       ///< of Solver::automatic
  std::string instruction_set;
  PhaseTimes time;               ///< of this rank
  std::uint64_t held_bytes = 0;  ///< by all ranks at the end of the solve, what they share counted once
};

}  // namespace fluxel
