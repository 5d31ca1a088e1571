#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "formfactor/exchange.hpp"
#include "formfactor/pair_rule.hpp"

namespace fluxel {

/// What a surface is the front or the back of.
enum class SurfacesOf { groups, patches };

/// The number of a surface, by that of its group or patch.
[[nodiscard]] constexpr std::uint32_t surface_of(std::uint32_t number, bool back) {
  return 2 * number + (back ? 1 : 0);
}

/// The exchange area of two surfaces, from <= to; of one with itself every pair of faces counts once. As
/// small as it can be: of many surfaces there are as many as half of their square.
struct SurfaceExchange {
  std::uint32_t from = 0, to = 0;
  double G = 0;         ///< [m2]
  float error = 0;      ///< of quadrature, at most about this [m2]
  float deviation = 0;  ///< standard error of visibility [m2]

  /// Of the same surfaces: errors of quadrature add up, those of visibility in their squares.
  SurfaceExchange& operator+=(const SurfaceExchange& other);
  [[nodiscard]] double total_error() const { return double{error} + double{deviation}; }  ///< [m2]
};

struct SurfaceExchanges {
  std::vector<SurfaceExchange> list;
  std::uint64_t rays = 0;  ///< that were traced for them
};

/// All pairs of faces of a scene, a face being a side that is an unknown of a piece, in blocks of rows that
/// can be worked on anywhere.
class FacePairs {
 public:
  /// Both must outlive this. `surfaces`: what exchanges are summed over. `tolerance`: of a pair's exchange
  /// area relative to itself, but no finer than of kMinFactor times the smaller area. Where something stands
  /// between, rays find the visible part to sqrt(kSampledTolerance * tolerance) of the same.
  FacePairs(const RayScene& ray_scene, const Scene& scene, double tolerance,
            SurfacesOf surfaces = SurfacesOf::groups);

  [[nodiscard]] std::size_t faces() const { return faces_.size(); }
  [[nodiscard]] std::size_t rows() const { return clusters_.size(); }  ///< clusters of faces

  /// Pairs of the faces of a cluster with those of this and all later clusters.
  [[nodiscard]] std::size_t pairs_of_row(std::size_t row) const;

  /// What these exchange, summed by surfaces, in the order of their numbers. Depends on the row alone.
  /// Calls `looked_at` with the number of pairs that have been looked at since the last call: after each that
  /// needed rays, which may take long, and every kilopair.
  [[nodiscard]] SurfaceExchanges examine_row(
      std::size_t row, const std::function<void(std::size_t)>& looked_at = [](std::size_t) {}) const;

  /// Area of the faces of each surface [m2], 0 where no side of it is an unknown.
  [[nodiscard]] std::vector<double> surface_areas() const;

 private:
  struct Face {
    SampledPolygon polygon;
    FlatShape shape;
    Box box;
    PatchId patch;
    std::uint32_t surface;
  };
  struct Cluster {
    std::size_t first, last;
    Box box;
  };

  void add_face(const Piece& piece, std::uint32_t side);
  [[nodiscard]] Exchange examine_pair(std::size_t a, std::size_t b,
                                      std::span<const PatchId> candidates) const;

  const Scene& scene_;
  OcclusionScene occlusion_;
  double tolerance_;
  SurfacesOf surfaces_;
  std::vector<Face> faces_;
  std::vector<Cluster> clusters_;
};

/// The finest tolerance that can be asked for: contour integrals are made with ContourPoints::fine at most,
/// whose error over the smaller area is 3e-8, of slivers more, and ends of rays are rounded to 6e-8.
inline constexpr double kMinViewFactorTolerance = 1e-7;

/// The tolerance of what rays find is the geometric mean of this and the one asked for: the number of rays
/// grows faster than their error falls, so that a hundred times finer asks for ten times finer of them.
inline constexpr double kSampledTolerance = 1e-3;

/// Below this form factor errors count absolutely.
inline constexpr double kMinFactor = 0.01;

/// The areas of groups' surfaces by those of patches' [m2].
[[nodiscard]] std::vector<double> areas_of_groups(const Scene& scene, std::span<const double> of_patches);

/// Exchanges between groups' surfaces, of those between patches', in the order of the numbers.
[[nodiscard]] std::vector<SurfaceExchange> exchange_of_groups(const Scene& scene,
                                                              std::span<const SurfaceExchange> of_patches);

/// Entries of equal surfaces added up in the order they come in; sorted by the surfaces' numbers.
[[nodiscard]] std::vector<SurfaceExchange> sum_by_surfaces(std::vector<SurfaceExchange> list);

/// The same of lists that sum_by_surfaces has made, as if they stood one after another.
[[nodiscard]] std::vector<SurfaceExchange> merge_sums(std::span<const std::vector<SurfaceExchange>> lists);

}  // namespace fluxel
