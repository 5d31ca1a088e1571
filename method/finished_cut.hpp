#pragma once

#include <optional>
#include <vector>

#include "hierarchy/cut_light.hpp"
#include "reference/finished_light.hpp"
#include "subdivision/piece_finder.hpp"

namespace fluxel {

/// What the faces below a cut reflect.
class FinishedCut final : public FinishedLight {
 public:
  /// What the light is of must outlive this.
  FinishedCut(const NodeTree& tree, const CutLight& light);

  [[nodiscard]] Rgb reflected(PatchId patch, bool front, const glm::dvec3& point) const override;
  /// Of a node of the cut by about the power that it reflects, and there by area.
  [[nodiscard]] std::optional<DrawnPoint> draw(double u, double v) const override;
  [[nodiscard]] double density(PatchId patch, bool front, const glm::dvec3& point) const override;

 private:
  [[nodiscard]] NodeId leaf_at(PatchId patch, bool front, const glm::dvec3& point) const;

  const NodeTree& tree_;
  CutLight light_;
  PieceFinder pieces_;
  std::vector<double> ends_;  // running sums of the power of the nodes
};

}  // namespace fluxel
