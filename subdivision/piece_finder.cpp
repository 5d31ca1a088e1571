#include "subdivision/piece_finder.hpp"

#include <algorithm>
#include <glm/geometric.hpp>
#include <limits>

namespace fluxel {

namespace {

/// Of the scene's extent: what points may lie beside their piece in its plane.
constexpr double kRounding = 1e-9;

/// Likewise: what points may lie off the plane of their piece, which rays find in single precision and files
/// give with few digits.
constexpr double kOffPlane = 1e-6;

/// Distance [m] of a point of the patch's plane from the piece's outline, positive inside.
double depth_in_outline(const Outline<glm::dvec3>& outline, const glm::dvec3& normal,
                        const glm::dvec3& point) {
  double least = std::numeric_limits<double>::infinity();
  for (std::uint32_t c = 0; c < outline.corners; ++c) {
    const glm::dvec3 from = outline.corner[c];
    const glm::dvec3 along = glm::normalize(outline.corner[(c + 1) % outline.corners] - from);
    least = std::min(least, glm::dot(glm::cross(normal, along), point - from));
  }
  return least;
}

}  // namespace

PieceFinder::PieceFinder(const Scene& scene)
    : scene_(scene),
      first_(scene.patches.size()),
      count_(scene.patches.size()),
      grid_of_(scene.patches.size()) {
  for (std::size_t piece = 0; piece < scene.pieces.size(); ++piece) {
    const std::size_t patch = index(scene.pieces[piece].patch);
    if (count_[patch]++ == 0) first_[patch] = static_cast<std::uint32_t>(piece);
  }
  const double margin = scene.extent * kOffPlane;
  for (std::size_t patch = 0; patch < count_.size(); ++patch) {
    if (count_[patch] <= kFewOutlines) continue;
    std::vector<PlaneGrid::Entry> entries;
    for (std::uint32_t piece = first_[patch]; piece < first_[patch] + count_[patch]; ++piece)
      entries.push_back(PlaneGrid::entry(scene.pieces[piece].outline, margin, piece));
    grid_of_[patch] = static_cast<std::uint32_t>(grids_.size());
    grids_.emplace_back(entries, scene.patches[patch].normal);
  }
}

std::size_t PieceFinder::find(PatchId patch, const glm::dvec3& point) const {
  const std::size_t first = first_[index(patch)], count = count_[index(patch)];
  if (count == 0) return kNone;
  if (count == 1) return first;
  std::size_t best = first;
  double best_depth = -std::numeric_limits<double>::infinity();
  const auto look_at = [&](std::size_t piece) {
    const double depth = depth_in_outline(scene_.pieces[piece].outline, scene_.patch(patch).normal, point);
    // On a cut the lower one has the point, in whatever order they are looked at.
    if (depth > best_depth || (depth == best_depth && piece < best)) {
      best = piece;
      best_depth = depth;
    }
  };
  if (count > kFewOutlines) {
    for (const std::uint32_t piece : grids_[grid_of_[index(patch)]].around(point)) look_at(piece);
    if (best_depth >= -scene_.extent * kRounding) return best;
  }
  // Beside all of them: the nearest. Well inside of one it is outside of the others.
  for (std::size_t piece = first; piece < first + count && best_depth <= scene_.extent * kRounding; ++piece)
    look_at(piece);
  return best;
}

}  // namespace fluxel
