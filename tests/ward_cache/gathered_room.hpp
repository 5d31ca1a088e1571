#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "app/command_line.hpp"
#include "core/options.hpp"
#include "hierarchy/link_hierarchy.hpp"
#include "method/problem.hpp"
#include "method/sparse_gather.hpp"
#include "subdivision/piece_finder.hpp"
#include "tests/ward_cache/hemisphere.hpp"
#include "visibility/first_side.hpp"

namespace fluxel::ward_cache {

/// The light of a room that has been solved for, at each pixel of its picture.
class GatheredRoom {
 public:
  /// By links; `ray_error`: of what records gather (see GatherGoal), which `finer` times as well is the
  /// truth. One process. Throws InputError where the request has no camera.
  GatheredRoom(const Communicator& world, const SolveRequest& request, double ray_error, double finer);

  [[nodiscard]] int width() const { return options_.camera->width; }
  [[nodiscard]] std::span<const SidePoint> seen() const { return seen_; }  ///< row-major
  /// What a record at the pixel's place gathers of reflected light [W/m2].
  [[nodiscard]] const Rgb& record(std::uint32_t pixel) const { return records_[pixel]; }
  [[nodiscard]] std::span<const Rgb> records() const { return records_; }  ///< likewise, of all pixels
  /// Of the radiosity of pixels that reflect and do not emit by these irradiances, an entry a pixel of the
  /// picture, against the truth: root mean square over the mean of all their light, mean of the colours.
  [[nodiscard]] double error_of(std::span<const Rgb> irradiance) const;
  /// By as many records as come to an error that is allowed.
  [[nodiscard]] SparseLight gather_sparsely(double allowed);

  /// What a pixel's place sees of reflected light.
  [[nodiscard]] HemisphereLight look_around(std::uint32_t pixel, const Strata& strata) const;
  /// Distance between what pixels beside each other see there, on a plane across the ray [m].
  [[nodiscard]] double footprint(std::uint32_t pixel) const;

 private:
  [[nodiscard]] Problem problem();
  [[nodiscard]] Sight look(const glm::dvec3& from, const glm::dvec3& direction) const;

  Options options_;
  SilentProgress progress_;
  SilentLog log_;
  const Communicator& world_;
  Scene scene_;
  RayScene ray_scene_;
  FirstSide first_side_;
  PieceFinder pieces_;
  LinkHierarchy hierarchy_;
  double ray_error_;
  std::vector<Rgb> B_;  // reflected, of all nodes [W/m2]
  std::vector<GatherPoint> points_;
  std::vector<SidePoint> seen_;
  std::vector<std::uint32_t> reflecting_;  // pixels
  Rgb mean_{0};                            // radiosity of those [W/m2]
  std::vector<Rgb> records_, truth_;       // of each pixel [W/m2]
};

}  // namespace fluxel::ward_cache
