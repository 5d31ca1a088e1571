#include "scene/cut_patches.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "core/progress.hpp"
#include "scene/contact_pairs.hpp"
#include "scene/coplanar.hpp"
#include "scene/most_crossed.hpp"
#include "scene/polygon.hpp"
#include "scene/sealed_sides.hpp"

namespace fluxel {
namespace {

/// Of the contact tolerance: what a parallelogram's corners may be off by rounding, 1e-12 of the diagonal.
constexpr double kRounding = 1e-6;

/// Of the contact tolerance: so near to another patch, and a little farther, rays do not tell its sides
/// apart.
constexpr double kNarrowest = 2;

// Beyond all three a scene is not meant. Boxes on a floor make some ten parts each, of five patches; an egg
// crate makes one or two a contact; patches that cross as they like make half as many as a patch has
// contacts.
constexpr std::size_t kMaxParts = 500'000;
constexpr std::size_t kMaxPartsAPatch = 32;
constexpr std::size_t kMaxPartsAContact = 2;

/// Whether both parts that a plane cuts a polygon into reach so far from it.
bool reaches_both_sides(PolygonView polygon, const Plane& plane, double distance) {
  double front = 0, back = 0;
  for (const glm::dvec3& x : polygon) {
    const double height = plane.distance(x);
    front = std::max(front, height);
    back = std::max(back, -height);
  }
  return std::min(front, back) > distance;
}

/// Cuts the parts whose inside a contact crosses, each along the contact's whole line (an autopartition).
void cut_along(std::vector<Polygon>& parts, const Patch& patch, const Contact& contact, double tolerance) {
  const glm::dvec3 along = contact.segment.to - contact.segment.from;
  const Plane plane{contact.segment.from, glm::normalize(glm::cross(patch.normal, along))};
  const std::size_t count = parts.size();
  for (std::size_t i = 0; i < count; ++i) {
    if (!clip(contact.segment, parts[i], patch.normal, tolerance)) continue;
    if (!reaches_both_sides(parts[i], plane, kNarrowest * std::max(tolerance, contact.gap))) continue;
    Halves halves = split(parts[i], plane, tolerance);
    if (halves.front.empty() || halves.back.empty()) continue;
    parts[i] = std::move(halves.front);
    parts.push_back(std::move(halves.back));
  }
}

/// Cuts all patches along their contacts, which are in the order of the patches.
void cut_along_all(std::vector<std::vector<Polygon>>& parts, const Scene& scene,
                   const std::vector<Contact>& contacts, double tolerance, Progress* progress) {
  constexpr std::size_t kReportEvery = 1024;  // contacts
  const auto touching =
      static_cast<std::size_t>(std::ranges::count(contacts, 0.0, [](const Contact& c) { return c.gap; }));
  const std::size_t most =
      std::max({kMaxParts, kMaxPartsAPatch * parts.size(), kMaxPartsAContact * touching});
  std::size_t total = 0;
  for (const std::vector<Polygon>& of_patch : parts) total += of_patch.size();
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    // No scene is refused for what only hovers.
    if (contacts[k].gap > 0 && 2 * total > most) continue;
    std::vector<Polygon>& of_patch = parts[index(contacts[k].touched)];
    total -= of_patch.size();
    cut_along(of_patch, scene.patch(contacts[k].touched), contacts[k], tolerance);
    total += of_patch.size();
    if (total > most)
      throw InputError(
          fmt::format("patches touch and cross one another so often that cutting them there makes more than "
                      "{} parts of {} patches ({} of {} contacts are done): {}; take out what crosses by "
                      "mistake, or leave patches whole with --no-cut",
                      most, parts.size(), k, contacts.size(), most_crossed(scene, contacts)));
    if (progress != nullptr && (k + 1) % kReportEvery == 0)
      progress->update(static_cast<double>(k + 1), static_cast<double>(contacts.size()),
                       fmt::format("patches cut into {} parts where others cross them", total));
  }
}

/// A rim of a sheet, not much wider than what counts as touching (an oblique rim is wider than its sheet is
/// thick). Rays cannot tell the inside of the sheet, which one of the rim's sides sees, from the rooms beside
/// it.
bool is_rim(const Scene& scene, const Patch& patch, double tolerance) {
  return patch.sides == (kFront | kBack) && !scene.material(patch).emits() &&
         width(corners(patch.outline), patch.normal) <= kNarrowest * tolerance;
}

bool is_whole(const std::vector<Polygon>& parts, const Patch& patch) {
  const PolygonView outline = corners(patch.outline);
  return parts.size() == 1 && parts[0] == Polygon(outline.begin(), outline.end());
}

}  // namespace

void cut_patches(Scene& scene, const PatchMesh& mesh, bool cut_contacts, int threads, Progress* progress) {
  const double tolerance = contact_tolerance(scene);
  const ContactPairs pairs = find_contact_pairs(scene, tolerance, cut_contacts, threads);

  std::vector<std::vector<Polygon>> parts(scene.patches.size());
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const PolygonView outline = corners(scene.patches[i].outline);
    parts[i].emplace_back(outline.begin(), outline.end());
  }
  take_covered_areas(scene, pairs.overlaps, tolerance, parts);
  take_touching_areas(scene, pairs.facing, patches_of_bodies(scene, mesh), tolerance, parts);
  cut_along_all(parts, scene, pairs.contacts, tolerance, progress);

  std::size_t cut_pieces = 0, rims = 0;
  scene.pieces.clear();
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const PatchId id{static_cast<std::uint32_t>(i)};
    if (is_rim(scene, scene.patches[i], tolerance)) {
      ++rims;
      continue;
    }
    if (is_whole(parts[i], scene.patches[i])) {
      scene.pieces.push_back({scene.patches[i].outline, id});
      continue;
    }
    const std::size_t before = scene.pieces.size();
    for (const Polygon& part : parts[i]) {
      for (const auto& outline : to_outlines(part, kRounding * tolerance))
        scene.pieces.push_back({outline, id});
    }
    const std::size_t made = scene.pieces.size() - before;
    if (made > 1) {
      ++scene.statistics.cut_patches;
      cut_pieces += made;
    }
  }
  if (rims > 0) {
    scene.notes.push_back(fmt::format(
        "{} two-sided {} narrower than {:.2g} m and only {} in the way of light", rims,
        rims == 1 ? "patch is" : "patches are", kNarrowest * tolerance, rims == 1 ? "stands" : "stand"));
  }
  if (scene.statistics.cut_patches > 0) {
    scene.notes.push_back(fmt::format(
        "{} {} cut into {} pieces where others touch, cross, cover or nearly touch {}",
        scene.statistics.cut_patches, scene.statistics.cut_patches == 1 ? "patch was" : "patches were",
        cut_pieces, scene.statistics.cut_patches == 1 ? "it" : "them"));
  }
}

}  // namespace fluxel
