#include "scene/doubts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "scene/list_names.hpp"

namespace fluxel {

namespace {

/// Fresh snow and the best coatings: of paint and plaster there is none as bright.
constexpr double kBrightest = 0.95;

std::string count_of(std::size_t count, const char* one, const char* several) {
  return fmt::format("{} {}", count, count == 1 ? one : several);
}

/// Names of materials in use that are brighter. Heat has such surfaces: metals, and all of a given flux.
std::vector<std::string> brightest_materials(const Scene& scene) {
  std::set<std::size_t> used;
  for (const Patch& patch : scene.patches) used.insert(index(patch.material));
  std::vector<std::string> names;
  for (const std::size_t k : used) {
    const Material& material = scene.materials[k];
    const double brightest = std::max({material.rho.r, material.rho.g, material.rho.b});
    if (brightest > kBrightest && !material.thermal) names.push_back(material.name);
  }
  return names;
}

}  // namespace

std::vector<std::string> doubts_of(const Scene& scene) {
  const SceneStatistics& of = scene.statistics;
  std::vector<std::string> doubts = scene.warnings;
  if (of.flipped_edges > 0)
    doubts.push_back(fmt::format(
        "{} two patches that face opposite ways: a flipped winding? One-sided, the back of one is dark, and "
        "lights emit from their fronts",
        count_of(of.flipped_edges, "edge joins", "edges join")));
  if (!of.closed && of.boundary_edges > 0)
    doubts.push_back(fmt::format("{} to one patch alone: where no opening is meant, light leaves by a gap",
                                 count_of(of.boundary_edges, "edge belongs", "edges belong")));
  if (of.nonmanifold_edges > 0)
    doubts.push_back(fmt::format("{} to more than two patches: walls within walls, or faces given twice?",
                                 count_of(of.nonmanifold_edges, "edge belongs", "edges belong")));
  if (of.coplanar_overlaps > 0)
    doubts.push_back(
        fmt::format("{} in one plane, {:.3g} m2 of them: a face given twice, or a thing that lies on "
                    "another? What is covered is left out",
                    count_of(of.coplanar_overlaps, "pair of patches overlaps", "pairs of patches overlap"),
                    of.covered_area));
  if (of.degenerate_faces > 0)
    doubts.push_back(fmt::format("{} dropped, as too small or without an area",
                                 count_of(of.degenerate_faces, "face is", "faces are")));
  if (const std::vector<std::string> names = brightest_materials(scene); !names.empty())
    doubts.push_back(
        fmt::format("reflectances above {} are hardly real, and light then takes long to fade: {}",
                    kBrightest, list_names(names)));
  return doubts;
}

}  // namespace fluxel
