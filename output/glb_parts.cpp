#include "output/glb_parts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <string>
#include <unordered_map>
#include <utility>

#include "core/hash.hpp"
#include "core/options.hpp"
#include "core/version.hpp"
#include "output/element_colours.hpp"
#include "output/outcome.hpp"
#include "solver/unknowns.hpp"

namespace fluxel {

namespace {

/// A corner of a side of a patch; elements that share one share its light.
struct Corner {
  glm::vec3 position{0};
  std::uint32_t patch = 0;
  std::uint32_t back = 0;

  bool operator==(const Corner&) const = default;
};

struct HashCorner {
  std::size_t operator()(const Corner& corner) const {
    const glm::vec3 unsigned_zero = corner.position + 0.0F;  // equal corners must hash alike
    const std::array<std::uint32_t, 2> side{corner.patch, corner.back};
    return hash_bytes(std::as_bytes(std::span(&unsigned_zero, 1)),
                      hash_bytes(std::as_bytes(std::span(side))));
  }
};

/// The triangles of the groups, their vertices' light the mean of the elements around, by area.
class SmoothMesh {
 public:
  explicit SmoothMesh(const OutputSource& source)
      : record_(source.record),
        mesh_(source.record.solution.subdivided.mesh),
        curve_(curve_of_elements(source)) {
    parts_.resize(record_.scene.groups.size());
    weights_.resize(parts_.size());
    for (std::size_t k = 0; k < parts_.size(); ++k) parts_[k].name = record_.scene.groups[k];
  }

  [[nodiscard]] std::vector<GlbPart> parts() && {
    for (std::size_t i = 0; i < mesh_.elements.size(); ++i) {
      const Element& element = mesh_.elements[i];
      if ((element.sides & kFront) != 0) add(i, false);
      if ((element.sides & kBack) != 0) add(i, true);
    }
    for (std::size_t k = 0; k < parts_.size(); ++k) {
      GlbPart& part = parts_[k];
      for (std::size_t v = 0; v < part.radiosity.size(); ++v) {
        part.radiosity[v] /= weights_[k][v];
        part.colours.push_back(curve_.shown(part.radiosity[v] / std::numbers::pi));
      }
    }
    return std::move(parts_);
  }

 private:
  void add(std::size_t number, bool back) {
    const Element& element = mesh_.elements[number];
    const Rgb& B = record_.solution.radiosity->B[number + (back ? mesh_.elements.size() : 0)];
    const std::size_t group = index(record_.scene.patch(element.patch).group);
    GlbPart& part = parts_[group];
    const Outline<glm::vec3> outline = back ? reversed(mesh_.outlines[number]) : mesh_.outlines[number];
    std::array<std::uint32_t, 4> vertex{};
    for (std::size_t k = 0; k < outline.corners; ++k) {
      const Corner corner{outline.corner[k], static_cast<std::uint32_t>(element.patch), back ? 1U : 0U};
      const auto [entry, is_new] =
          vertices_.try_emplace(corner, static_cast<std::uint32_t>(part.positions.size()));
      if (is_new) {
        part.positions.push_back(corner.position);
        part.radiosity.emplace_back(0);
        weights_[group].push_back(0);
      }
      vertex[k] = entry->second;
      const auto area = static_cast<double>(element.area);
      part.radiosity[vertex[k]] += area * B;
      weights_[group][vertex[k]] += area;
    }
    for (std::size_t k = 2; k < outline.corners; ++k)
      part.corners.insert(part.corners.end(), {vertex[0], vertex[k - 1], vertex[k]});
  }

  const RunRecord& record_;
  ElementView mesh_;
  ToneCurve curve_;
  std::vector<GlbPart> parts_;
  std::vector<std::vector<double>> weights_;  // of the parts' vertices
  std::unordered_map<Corner, std::uint32_t, HashCorner> vertices_;
};

/// Those of a mesh with light of its own; a vertex belongs to one side of one patch.
std::vector<GlbPart> parts_of(const BakedMesh& baked, const Scene& scene, const ToneCurve& curve) {
  const Unknowns unknowns = make_unknowns(baked.mesh.elements, scene.materials);
  constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> number(baked.vertices.size(), kNone);  // in its part
  std::vector<GlbPart> parts(scene.groups.size());
  for (std::size_t k = 0; k < parts.size(); ++k) parts[k].name = scene.groups[k];
  for (std::size_t k = 0; k < unknowns.size(); ++k) {
    if (!(unknowns.area[k] > 0)) continue;
    const std::size_t element = k % baked.mesh.elements.size();
    GlbPart& part = parts[index(scene.patch(baked.mesh.elements[element].patch).group)];
    const std::size_t corners = baked.mesh.outlines[element].corners;
    std::array<std::uint32_t, 4> vertex{};
    for (std::size_t c = 0; c < corners; ++c) {
      const std::uint32_t of_mesh = baked.corners[k][c];
      if (number[of_mesh] == kNone) {
        number[of_mesh] = static_cast<std::uint32_t>(part.positions.size());
        part.positions.push_back(baked.vertices[of_mesh]);
        part.radiosity.push_back(unknowns.E[k] + unknowns.rho[k] * baked.H_of_vertices[of_mesh]);
        part.colours.push_back(curve.shown(part.radiosity.back() / std::numbers::pi));
      }
      vertex[c] = number[of_mesh];
    }
    if (k != element) std::reverse(vertex.begin(), vertex.begin() + static_cast<std::ptrdiff_t>(corners));
    for (std::size_t c = 2; c < corners; ++c)
      part.corners.insert(part.corners.end(), {vertex[0], vertex[c - 1], vertex[c]});
  }
  return parts;
}

}  // namespace

std::vector<GlbPart> glb_parts(const OutputSource& source) {
  const Solution& solution = source.record.solution;
  if (solution.mesh) return parts_of(*solution.mesh, source.record.scene, curve_of_elements(source));
  return SmoothMesh(source).parts();
}

GlbScene glb_scene(const RunRecord& record) {
  const std::optional<Camera>& camera = record.options.camera;
  const bool z_up = camera && std::abs(camera->up.z) > std::abs(camera->up.y);
  return {record.scene.origin, z_up, "Fluxel " + std::string(version()), unreached(record)};
}

}  // namespace fluxel
