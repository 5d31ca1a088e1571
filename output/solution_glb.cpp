#include "output/solution_glb.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>
#include <unordered_map>

#include "core/hash.hpp"
#include "core/version.hpp"
#include "output/element_colours.hpp"
#include "output/elements/glb_writer.hpp"

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

}  // namespace

void write_solution_glb(const std::filesystem::path& file, const OutputSource& source) {
  const RunRecord& record = source.record;
  const bool z_up =
      record.options.camera && std::abs(record.options.camera->up.z) > std::abs(record.options.camera->up.y);
  write_glb(file, SmoothMesh(source).parts(), record.scene.origin, z_up, "Fluxel " + std::string(version()));
}

}  // namespace fluxel
