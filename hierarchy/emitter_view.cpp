#include "hierarchy/emitter_view.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace fluxel {

namespace {

/// A cluster farther away than so many of its radii is as good as a point.
constexpr double kFarRadii = 4;

}  // namespace

EmitterView::EmitterView(const EmitterDraw& emitters, const ReceivingPoint& at)
    : emitters_(emitters), at_(at) {
  if (emitters.empty()) return;
  // Of a cluster that may be opened: about the most that it can bring.
  const auto opens = [&](const Part& part) {
    const Node& node = emitters_.tree_[part.node];
    if (!emitters_.tree_.is_cluster(part.node)) return 0.0;
    const double distance = glm::distance(node.shape.centroid, at_.position);
    if (distance > kFarRadii * node.radius) return 0.0;
    const double nearest = std::max(distance - node.radius, node.radius / kFarRadii);
    return emitters_.power_[part.node] / (nearest * nearest);
  };
  parts_.push_back({0, opens({0, 0})});
  while (parts_.size() < kMostParts) {
    const auto most = std::ranges::max_element(parts_, {}, &Part::end);
    if (!(most->end > 0)) break;
    const auto [a, b] = emitters_.tree_[most->node].child;
    *most = {a, 0};
    most->end = opens(*most);
    if (emitters_.power_[b] > 0) parts_.push_back({b, opens({b, 0})});
    if (!(emitters_.power_[a] > 0)) {
      parts_[static_cast<std::size_t>(most - parts_.begin())] = parts_.back();
      parts_.pop_back();
    }
  }
  double sum = 0;
  for (Part& part : parts_) {
    const double weight = emitters_.apparent_power(part.node, at_);
    part.end = weight > 0 ? sum += weight : 0;
  }
  // None of these is drawn, whatever rounding makes of a choice.
  parts_.erase(std::remove_if(parts_.begin(), parts_.end(), [](const Part& part) { return part.end == 0; }),
               parts_.end());
}

DrawnEmitter EmitterView::draw(double choice, double u, double v) const {
  const double sum = parts_.back().end, at = choice * sum;
  const auto found = std::ranges::upper_bound(parts_, at, {}, &Part::end);
  const auto part = std::min(static_cast<std::size_t>(found - parts_.begin()), parts_.size() - 1);
  const double weight = weight_of(part);
  const double rest = std::clamp((at - (parts_[part].end - weight)) / weight, 0.0, std::nextafter(1.0, 0.0));
  return emitters_.draw_below(parts_[part].node, weight / sum, at_, rest, u, v);
}

double EmitterView::density(NodeId face, const glm::dvec3& of) const {
  // Up to a part of the cut.
  double chance = 1;
  for (NodeId id = face; id != kNoNode; id = emitters_.tree_[id].parent) {
    const auto found = std::ranges::find(parts_, id, &Part::node);
    if (found != parts_.end()) {
      const double weight = weight_of(static_cast<std::size_t>(found - parts_.begin()));
      return empty() ? 0 : chance * weight / parts_.back().end * emitters_.density_on(face, of, at_.position);
    }
    if (const NodeId parent = emitters_.tree_[id].parent; parent != kNoNode) {
      const auto [a, b] = emitters_.tree_[parent].child;
      chance *= emitters_.share(id, id == a ? b : a, at_);
    }
  }
  return 0;
}

}  // namespace fluxel
