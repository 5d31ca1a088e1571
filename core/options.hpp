#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/camera.hpp"
#include "core/choices.hpp"
#include "core/material.hpp"

namespace fluxel {

/// Of a run's work, unless it is told another.
inline constexpr double kAuditShare = 0.1;

/// Everything that a run is asked for, after the scene file and the command line have been merged.
struct Options {
  std::string scene;
  std::optional<double> metres_per_unit;  ///< of a geometry file; unset: as the file is, or a scene file says
  std::string out = "out";
  std::vector<std::string>
      write;  ///< files that a run writes where it is asked, by the names of the outputs' table

  std::optional<Camera> camera;
  int supersample = 1;             ///< rays a pixel along each axis
  bool antialias = true;           ///< more where surfaces meet; of a supersample of 1
  int median_radius = 0;           ///< of the filter of the finished picture [pixels]; 0: none
  std::optional<double> exposure;  ///< [stops]: shown is radiance * 2^exposure; unset: chosen
  Tone tone = Tone::reinhard;
  FalseColourScale false_colour;
  double maintenance_factor = 1;  ///< of tasks: what is left of a new installation's illuminance (CIE 97)

  Sides sides = Sides::two;
  KeMeaning ke = KeMeaning::radiance;  ///< of OBJ files
  Textures textures = Textures::mean;
  Specular specular = Specular::refuse;
  bool thermal = false;  ///< heat between grey surfaces, from temperatures and fluxes, in place of light
  bool cut = true;
  bool merge = true;              ///< coplanar polygons, where patches are cut and split into elements
  bool trace_every_pair = false;  ///< no shortcuts in visibility: a ray for every pair that faces each other

  Method method = Method::hierarchical;
  std::string solution;                ///< of view: solution.ply that is looked at
  std::optional<double> target_error;  ///< of hierarchical: root mean square over the mean
  std::optional<ErrorOf> error_of;     ///< unset: the picture, without a camera the surfaces
  std::optional<double> block_error;   ///< of hierarchical, in place of target_error: see RefinementGoal
  Oracle oracle = Oracle::all;
  ExchangeBy exchange = ExchangeBy::automatic;
  PictureFrom picture = PictureFrom::cached;
  std::optional<std::uint64_t>
      memory;  ///< of hierarchical: of this rank [bytes]; unset: what the machine has
  std::optional<double>
      seconds;  ///< of hierarchical: wall-clock time, from the start of the run; unset: no limit
  Subdivision subdivision = Subdivision::transport;  ///< transport: the leaves of hierarchical
  std::optional<double> max_edge;                    ///< [m]
  std::optional<double>
      mesh_max_edge;  ///< [m], of the faces of meshes that are written; unset: they are the elements
  std::optional<double> lightmap_texel;  ///< [m], at most; unset: what fits into a usual map
  Subscenes subscenes = Subscenes::merged;

  FormFactorOptions form_factor;
  Solver solver = Solver::automatic;
  std::optional<double>
      tolerance;  ///< of max |B - B*| over the area-mean of B; unset: by discretisation_share
  double discretisation_share = 0.1;  ///< of the estimated discretisation error, where the iteration ends
  int max_iterations = 1000;
  std::string warm_start;  ///< solution.ply of an earlier run; empty: none
  bool preview = false;    ///< pictures after 1, 2, 4 and 8 s of shooting

  bool error_estimate = true;  ///< from coarser meshes, after the solution
  double audit = kAuditShare;  ///< of a run's work, that goes into measuring its error; 0: it is not measured

  bool keep_links = false;        ///< of hierarchical: for views of the solution
  std::string checkpoint;         ///< folder that keeps finished strips; empty: none
  double checkpoint_every = 300;  ///< [s]
  bool resume = false;            ///< with the strips that the folder has
  bool visibility_only = false;   ///< end when the matrix is complete and kept
  std::string reuse_visibility;   ///< folder of strips to read; empty: none

  int threads = 0;  ///< in a rank; 0: as many as the rank's CPU set has
  Isa isa = Isa::automatic;
  Device device = Device::cpu;
  double verify_device = 1e-4;  ///< share of a GPU's tiles or paths that the processor makes again
  bool quiet = false;
  bool live = false;    ///< the page of the run is written while it lasts
  std::string command;  ///< that was given
  bool dry_run = false;
  bool timeline = false;  ///< what ranks did when, as a file

  [[nodiscard]] bool writes(std::string_view name) const {
    return std::find(write.begin(), write.end(), name) != write.end();
  }
};

/// Of hierarchical runs that are given no other.
inline constexpr double kTargetError = 0.01;

/// Of all target errors: elements are held in single precision, and rays start a millionth of the scene off
/// their surface.
inline constexpr double kLeastTargetError = 1e-6;

[[nodiscard]] inline ErrorOf error_of(const Options& options) {
  const bool shown = options.camera && !options.thermal;
  return options.error_of.value_or(shown ? ErrorOf::picture : ErrorOf::surfaces);
}

/// Whether errors are looked at where the camera looks, and not on all surfaces.
[[nodiscard]] inline bool error_is_of_picture(const Options& options) {
  return options.camera && !options.thermal && error_of(options) != ErrorOf::surfaces;
}

/// Where no limit of sensors is asked for: their relative error.
inline constexpr double kReferenceError = 0.01;

/// How exact sensors shall become.
struct ErrorLimits {
  std::optional<double> target_error;    ///< standard error, root mean square over the mean
  std::optional<double> absolute_error;  ///< the same without the mean, in the unit of what is measured
  std::string of;  ///< of which sensors: elements, picture, or a receiver's name; empty: of each kind

  /// Whether that is of such sensors; a receiver may also be called "receiver NAME".
  [[nodiscard]] bool is_of(std::string_view kind, std::string_view receiver = {}) const {
    if (receiver.empty()) return of.empty() || of == kind;
    const bool is_kind = of == "elements" || of == "picture";
    return of.empty() || (of == receiver && !is_kind) || of == "receiver " + std::string(receiver);
  }

  [[nodiscard]] bool are_set() const { return target_error || absolute_error; }
  /// The larger of both over what is asked for: at most 1 where it is reached; 0 where nothing is asked for.
  [[nodiscard]] double excess(double relative, double absolute) const {
    return std::max(target_error ? relative / *target_error : 0,
                    absolute_error ? absolute / *absolute_error : 0);
  }
  /// What is asked for as a relative error, where the worst one is `relative` and has that excess.
  [[nodiscard]] double as_relative(double relative, double excess) const {
    return excess > 0 ? relative / excess : target_error.value_or(kReferenceError);
  }
};

/// When a reference is good enough. Where none is set, at kReferenceError.
struct ReferenceLimits {
  ErrorLimits error;
  std::optional<double> seconds;  ///< of wall-clock time
  std::optional<std::uint64_t> rays;
};

/// When photons are enough. Where none is set, at kReferenceError.
struct PhotonLimits {
  ErrorLimits error;
  std::optional<double> seconds;          ///< of wall-clock time
  std::optional<std::uint64_t> photons;   ///< that are sent
  std::optional<std::uint64_t> received;  ///< that have come to ErrorLimits::of
};

/// What `fluxel reference` is asked for.
struct ReferenceOptions {
  Options run;           ///< of the scene, the camera, and how it is run; the rest is a solve's
  std::string elements;  ///< solution.ply whose elements are measured; empty: none
  int supersample = 0;   ///< 0: pixels are measured over their whole area
  Measured only = Measured::all;
  ReferenceLimits limits;  ///< of the elements, of the picture and of each receiver
  Sampling sampling = Sampling::blocks;
  std::uint64_t seed = 1;

  [[nodiscard]] bool measures(Measured what) const { return only == Measured::all || only == what; }
  [[nodiscard]] bool measures_elements() const { return !elements.empty() && measures(Measured::elements); }
  [[nodiscard]] bool measures_picture() const {
    return run.camera.has_value() && measures(Measured::picture);
  }
};

/// What `fluxel photons` is asked for.
struct PhotonOptions {
  Options run;  ///< of the scene, of max_edge and checkpoints, and how it is run; the rest is a solve's
  std::string elements;  ///< solution.ply whose elements receive; empty: by max_edge, or the patches' pieces
  Measured only = Measured::all;
  Sequence sequence = Sequence::sobol;
  PhotonLimits limits;
  std::uint64_t seed = 1;               ///< of Sequence::scrambled and random
  std::string changed_from;             ///< scene file whose photons are renewed; empty: none
  std::optional<std::uint64_t> groups;  ///< of those photons, at most; unset: by their number

  [[nodiscard]] bool measures(Measured what) const { return only == Measured::all || only == what; }
};

/// What `fluxel viewfactors` is asked for.
struct ViewFactorOptions {
  std::string scene;
  std::optional<double> metres_per_unit;  ///< as in Options
  std::string out = "out";                ///< folder
  std::vector<std::string> write;         ///< see output/group_factor_files.hpp and face_factor_files.hpp
  double tolerance = 1e-3;                ///< of a factor, relative; see FacePairs
  Sides sides = Sides::two;
  Specular specular = Specular::refuse;
  bool cut = true;
  bool merge = true;  ///< coplanar polygons of a group
  int threads = 0;    ///< in a rank; 0: as many as the rank's CPU set has
  bool quiet = false;
  std::string command;  ///< as in Options
};

/// What `fluxel compare` is asked for.
struct CompareOptions {
  std::string judged;                ///< file A, of elements or a picture
  std::string reference;             ///< file B
  std::string out;                   ///< folder; empty: nothing is written
  std::optional<double> fail_above;  ///< of FieldErrors::figure
  bool quiet = false;
  std::string command;  ///< as in Options
};

}  // namespace fluxel
