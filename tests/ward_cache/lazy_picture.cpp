#include "tests/ward_cache/lazy_picture.hpp"

#include <algorithm>
#include <glm/geometric.hpp>
#include <span>

namespace fluxel::ward_cache {

namespace {

/// Of the first grid [pixels].
constexpr std::uint32_t kFirstStep = 32;

/// Calls `visit(pixel)` for all of them, those of coarser grids first.
template <class Visit>
void visit_refining(std::uint32_t width, std::uint32_t height, const Visit& visit) {
  for (std::uint32_t step = kFirstStep; step > 0; step /= 2)
    for (std::uint32_t y = 0; y < height; y += step)
      for (std::uint32_t x = 0; x < width; x += step) {
        const bool came_before = step < kFirstStep && x % (2 * step) == 0 && y % (2 * step) == 0;
        if (!came_before) visit(y * width + x);
      }
}

}  // namespace

WardRecord LazyPainter::record(std::uint32_t pixel, const LazySettings& settings) {
  const auto [found, is_new] = around_.try_emplace(pixel);
  if (is_new) found->second = room_.look_around(pixel, strata_);
  const HemisphereLight& light = found->second;
  WardRecord made{room_.seen()[pixel], room_.record(pixel), light.rotation, light.translation,
                  light.mean_distance};
  if (settings.limits_by_gradient)
    for (int c = 0; c < kChannels; ++c) {
      const double slope = glm::length(light.translation[static_cast<std::size_t>(c)]);
      if (slope > 0) made.radius = std::min(made.radius, made.irradiance[c] / slope);
    }
  const double least = settings.least_pixels * room_.footprint(pixel) / settings.acceptance;
  if (made.radius < least) {
    // It would be followed farther than what it is made of goes on (Krivanek & Gautron 2009).
    for (glm::dvec3& slope : made.translation) slope *= made.radius / least;
    made.radius = least;
  }
  return made;
}

LazyPicture LazyPainter::paint(const LazySettings& settings) {
  const std::span<const SidePoint> seen = room_.seen();
  const auto width = static_cast<std::uint32_t>(room_.width());
  WardCache cache(settings.acceptance);
  // Radii that others have shortened leave gaps.
  for (std::size_t before = 0, passes = 0; passes == 0 || cache.size() > before; ++passes) {
    before = cache.size();
    visit_refining(width, static_cast<std::uint32_t>(seen.size()) / width, [&](std::uint32_t pixel) {
      if (seen[pixel].piece != SidePoint::kNothing && !cache.at(seen[pixel]))
        cache.add(record(pixel, settings));
    });
  }
  LazyPicture picture;
  picture.records = cache.size();
  for (const SidePoint& point : seen)
    picture.irradiance.push_back(point.piece == SidePoint::kNothing ? Rgb(0) : cache.at(point).value());
  return picture;
}

}  // namespace fluxel::ward_cache
