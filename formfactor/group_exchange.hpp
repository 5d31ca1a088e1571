#pragma once

#include <cstdint>
#include <vector>

#include "formfactor/exchange.hpp"
#include "formfactor/pair_rule.hpp"

namespace fluxel {

/// The exchange area of two groups, from <= to; of a group with itself every pair of faces counts once.
struct GroupExchange {
  std::uint32_t from = 0, to = 0;
  Exchange exchange;
};

/// All pairs of faces of a scene, a face being a side that is an unknown of a piece, in blocks of rows that
/// can be worked on anywhere.
class FacePairs {
 public:
  /// Both must outlive this. `tolerance`: of a pair's exchange area relative to itself, but no finer than of
  /// kLeastFactor times the smaller area. Where something stands between, rays find the visible part to
  /// sqrt(kSampledTolerance * tolerance) of the same.
  FacePairs(const RayScene& ray_scene, const Scene& scene, double tolerance);

  [[nodiscard]] std::size_t faces() const { return faces_.size(); }
  [[nodiscard]] std::size_t rows() const { return clusters_.size(); }  ///< clusters of faces

  /// Pairs of the faces of a cluster with those of this and all later clusters, summed by groups, in the
  /// order of the groups' numbers. Depends on the arguments alone.
  [[nodiscard]] std::vector<GroupExchange> examine_row(std::size_t row) const;

  /// Area of the faces of each group [m2].
  [[nodiscard]] std::vector<double> group_areas() const;

 private:
  struct Face {
    SampledPolygon polygon;
    FlatShape shape;
    Box box;
    PatchId patch;
    std::uint32_t group;
  };
  struct Cluster {
    std::size_t first, last;
    Box box;
  };

  void add_face(const Piece& piece, std::uint32_t side);
  [[nodiscard]] Exchange examine_pair(std::size_t a, std::size_t b,
                                      std::span<const PatchId> candidates) const;

  const Scene& scene_;
  PatchTree tree_;
  Obstacles obstacles_;
  double tolerance_;
  std::vector<Face> faces_;
  std::vector<Cluster> clusters_;
};

/// The tolerance of what rays find is the geometric mean of this and the one asked for: the number of rays
/// grows faster than their error falls, so that a hundred times finer asks for ten times finer of them.
inline constexpr double kSampledTolerance = 1e-3;

/// Below this form factor errors count absolutely.
inline constexpr double kLeastFactor = 0.01;

/// Entries of equal groups added up in the order they come in; sorted by the groups' numbers.
[[nodiscard]] std::vector<GroupExchange> sum_by_groups(std::vector<GroupExchange> list);

}  // namespace fluxel
