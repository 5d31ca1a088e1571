#pragma once

#include <optional>

#include "formfactor/free_segments.hpp"
#include "formfactor/seen_polygon.hpp"
#include "hierarchy/node_tree.hpp"

namespace fluxel {

/// A place of a face, and the form factor towards the face that it stands for: that of the face is the mean
/// over all places.
struct SenderPlace {
  SurfaceSegment segment;
  double F = 0;
};

/// The places of a face that rays from a point go to. Of a near face a small part may bring most of the
/// light, and where places are drawn alike over the area few of them would be there: they are drawn by their
/// directions.
class SenderPlaces {
 public:
  /// The point lies in front of the face. The tree must outlive this, and not be split.
  SenderPlaces(const NodeTree& tree, NodeId face, const glm::dvec3& point, const glm::dvec3& normal);

  /// From the unit square, u below 1. No form factor where the place is beyond the point's horizon.
  [[nodiscard]] SenderPlace at(double u, double v) const;

 private:
  Outline<glm::dvec3> outline_;
  const FlatShape& shape_;
  glm::dvec3 point_, normal_;
  std::optional<SeenPolygon> seen_;
};

}  // namespace fluxel
