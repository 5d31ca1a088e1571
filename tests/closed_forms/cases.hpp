#pragma once

#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "tests/closed_forms/polygons.hpp"

namespace fluxel::closed_forms {

/// Two groups of polygons with a view factor that is known. Sender and receiver send and receive on the faces
/// that their corners go around counter-clockwise; blockers are opaque from both sides and neither send nor
/// receive. Lengths near 1.
struct Case {
  std::string id, what;
  std::vector<Polygon> sender, receiver, blockers;
  double exact = 0;  ///< F from sender to receiver of the geometry that is meant
  /// (F of these polygons - exact) / exact: not 0 where polygons stand for something curved or infinite.
  double geometry_error = 0;
  bool occluded = false;  ///< the blockers hide something; other polygons never do
};

/// F of the polygons as they are.
[[nodiscard]] double polygon_truth(const Case& view);

/// A point's configuration factor that is known.
struct PointCase {
  std::string id, what;
  glm::dvec3 point{0}, normal{0};
  Polygon receiver;
  double exact = 0;
  double geometry_error = 0;  ///< as of Case
};

/// Flat polygons that see each other freely.
[[nodiscard]] std::vector<Case> flat_cases();

/// Discs, spheres and closed shells, as fine polygons.
[[nodiscard]] std::vector<Case> curved_cases();

/// Something stands between.
[[nodiscard]] std::vector<Case> occluded_cases();

/// All of the above. Takes some tenths of a second: geometry errors are computed.
[[nodiscard]] std::vector<Case> all_cases();

[[nodiscard]] std::vector<PointCase> point_cases();

}  // namespace fluxel::closed_forms
