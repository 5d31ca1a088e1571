#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/camera.hpp"
#include "core/raster.hpp"
#include "reference/sensors.hpp"
#include "scene/scene.hpp"
#include "visibility/ray_scene.hpp"

namespace fluxel {

/// Some of the places, by their numbers.
struct AuditPart {
  std::string name;
  std::vector<std::uint32_t> places;
};

/// Where a run is audited, and the parts of which each is looked at on its own: each group of surfaces and
/// each of 8 x 8 regions of the picture that has at least a hundredth of the places, and 16 of them.
struct AuditSubject {
  std::vector<SurfacePlace> places;  ///< those that follow one another are near each other
  std::vector<AuditPart> parts;
};

/// A place that a pixel shows.
struct PicturePlace {
  SurfacePlace place;
  std::uint32_t pixel = 0;
};

/// Some that reflect and do not emit, from all parts of the picture; neighbours are near each other. Where
/// two surfaces meet a path that is lifted off one may start behind the other: points so near an edge are
/// none.
[[nodiscard]] std::vector<PicturePlace> draw_picture_places(const RayScene& ray_scene, const Camera& camera,
                                                            int supersample, const Raster& raster);

/// The picture as these places stand for it.
[[nodiscard]] AuditSubject audit_picture(const Scene& scene, std::span<const PicturePlace> places,
                                         const Camera& camera, int supersample);

/// Places of all sides that reflect, of heat of all sides, evenly by area.
[[nodiscard]] AuditSubject audit_surfaces(const Scene& scene, bool thermal);

}  // namespace fluxel
