#pragma once

#include <span>
#include <vector>

#include "core/element.hpp"
#include "scene/scene.hpp"
#include "visibility/ray_scene.hpp"

namespace fluxel {

/// Where the radiosity of one side of an element goes, of stratified cosine-distributed rays.
struct SideView {
  float escape = 0;  ///< fraction that leaves the scene
  float dark = 0;    ///< fraction that ends where no side is an unknown, as on a one-sided patch's back
};

/// Of the sides of elements, an entry an element each; an entry whose side is no unknown is left alone.
struct SideViewSpans {
  std::span<SideView> front, back;
};

/// Rays a side: a square of strata.
inline constexpr int kEscapeStrata = 8;
inline constexpr int kEscapeRays = kEscapeStrata * kEscapeStrata;

/// Views of the elements [first, last), an entry of `views` each. Directions are cosine-distributed (Malley's
/// method: a disc's points lifted to the hemisphere; concentric map of Shirley & Chiu 1997), origins are
/// spread over the element by the same strata, shuffled; random numbers come from the element's number alone,
/// so that every partition gives the same views. The standard error of a fraction f is at most sqrt(f (1 - f)
/// / kEscapeRays).
void side_views(const RayScene& ray_scene, const Scene& scene, const ElementView& mesh, std::size_t first,
                std::size_t last, const SideViewSpans& views);

/// Of one side of an element; which of its rays go where depends on the arguments alone. As side_views has
/// it, with the seed 2 i for the front of element i, and 2 i + 1 for its back.
[[nodiscard]] SideView side_view(const RayScene& ray_scene, const Scene& scene, const ElementView& mesh,
                                 std::size_t element, bool front);

/// No ray of a side escapes.
[[nodiscard]] bool is_closed(std::span<const SideView> views);

}  // namespace fluxel
