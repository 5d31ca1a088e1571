#pragma once

#include <boost/container/static_vector.hpp>

#include "hierarchy/emitter_draw.hpp"

namespace fluxel {

/// Draws points of what emits from one point, from which many are drawn: what is near is looked at face by
/// face, by the light that each would bring if nothing stood before it, so that a small near lamp is found
/// beside large far ones (adaptive splitting of the tree: Conty Estevez & Kulla 2018; a cut through it for
/// each point: Walter et al. 2005).
class EmitterView {
 public:
  /// The emitters must outlive this.
  EmitterView(const EmitterDraw& emitters, const ReceivingPoint& at);

  /// Whether nothing emits towards the point.
  [[nodiscard]] bool empty() const { return parts_.empty() || !(parts_.back().end > 0); }
  /// As of EmitterDraw.
  [[nodiscard]] DrawnEmitter draw(double choice, double u, double v) const;
  [[nodiscard]] double density(NodeId face, const glm::dvec3& of) const;

 private:
  static constexpr std::size_t kMostParts = 32;

  struct Part {
    NodeId node = kNoNode;
    double end = 0;  // running sum of the weights
  };
  [[nodiscard]] double weight_of(std::size_t part) const {
    return parts_[part].end - (part > 0 ? parts_[part - 1].end : 0);
  }

  const EmitterDraw& emitters_;
  ReceivingPoint at_;
  boost::container::static_vector<Part, kMostParts> parts_;
};

}  // namespace fluxel
