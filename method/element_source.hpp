#pragma once

#include <cstdint>
#include <vector>

#include "hierarchy/irradiance_source.hpp"
#include "hierarchy/ray_gather.hpp"
#include "hierarchy/ray_light.hpp"
#include "method/problem.hpp"
#include "subdivision/element_finder.hpp"

namespace fluxel {

/// A finished solution that is known by the radiosity of elements, each as bright everywhere as on average.
/// What falls on a point comes by rays, see RayGather. It hears signals (see handle_signals).
class ElementSource final : public IrradianceSource {
 public:
  /// Collective. `irradiance` [W/m2] has an entry an unknown of the mesh; all must outlive this. `device`: of
  /// this rank, or null: see RayGather.
  ElementSource(const Problem& problem, const ElementView& mesh, std::span<const Rgb> irradiance,
                VerifiedHits* device = nullptr);

  [[nodiscard]] std::vector<Rgb> gather(std::span<const GatherPoint> points, const GatherGoal& goal,
                                        Progress& progress) override;
  [[nodiscard]] std::array<std::vector<Rgb>, 2> gather_halves(std::span<const GatherPoint> points,
                                                              const GatherGoal& goal,
                                                              Progress& progress) override;

  [[nodiscard]] bool by_rays() const override { return true; }
  [[nodiscard]] const NodeTree& tree() const override { return tree_; }
  [[nodiscard]] Rgb mean_radiosity() const override { return mean_radiosity_; }
  [[nodiscard]] std::uint64_t gather_rays() const override { return rays_.rays(); }

 private:
  void between_parts();

  /// What elements reflect.
  class Elements final : public SolutionLight {
   public:
    Elements(const NodeTree& tree, const ElementView& mesh, std::span<const Rgb> irradiance)
        : tree_(tree), mesh_(mesh), finder_(mesh), irradiance_(irradiance) {}
    [[nodiscard]] EndLight at(NodeId leaf, const glm::dvec3& point) const override;

   private:
    const NodeTree& tree_;
    ElementView mesh_;
    ElementFinder finder_;
    std::span<const Rgb> irradiance_;
  };

  const Problem& problem_;
  VerifiedHits* device_;
  Ranks ranks_;
  int threads_;
  NodeTree tree_;  // of whole pieces
  RayLight emitted_;
  Elements elements_;
  RayGather rays_;
  Rgb mean_radiosity_{0};
};

}  // namespace fluxel
