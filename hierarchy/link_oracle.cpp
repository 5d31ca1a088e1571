#include "hierarchy/link_oracle.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fluxel {

namespace {

/// Of the residual over the receiver: parts of a node have to be right one by one.
constexpr double kResidualShare = 3;

/// The part of what is exchanged that may be wrong where something stands between, and between clusters,
/// whose parts face each other more or less.
constexpr double kPartialShare = 0.2, kClusterShare = 0.5;

}  // namespace

LinkOracle::LinkOracle(const NodeTree& tree, std::span<const NodeLight> light, const RefinementGoal& goal,
                       double area, double epsilon)
    : tree_(tree),
      light_(light),
      heat_(goal.heat),
      epsilon_(epsilon),
      // Where nothing is sent, as between black walls under luminaires, nothing has to be right.
      allowed_(goal.mean_radiosity > 0 ? goal.error * (goal.mean_radiosity * std::sqrt(area))
                                       : std::numeric_limits<double>::infinity()) {}

LinkErrors LinkOracle::errors(NodeId p, NodeId q, const FacePair& pair, bool partial) const {
  const auto [to_p, to_q] = weights(p, q);
  const auto B_p = static_cast<double>(light_[p].B), B_q = static_cast<double>(light_[q].B);
  const auto deviation_p = static_cast<double>(light_[p].deviation),
             deviation_q = static_cast<double>(light_[q].deviation);
  // What a leaf receives is right in the mean, but its radiosity is taken as constant. Other nodes send
  // their first moments, and their parts have to receive what is theirs.
  const bool leaf_p = tree_[p].is_leaf(), leaf_q = tree_[q].is_leaf();
  return {to_p * (leaf_p ? 0 : kResidualShare * B_q * pair.p.residual) +
              to_q * deviation_p * (leaf_p ? pair.p.deviation : kResidualShare * pair.p.residual),
          to_q * (leaf_q ? 0 : kResidualShare * B_p * pair.q.residual) +
              to_p * deviation_q * (leaf_q ? pair.q.deviation : kResidualShare * pair.q.residual),
          partial ? pair.G * (to_p * (kPartialShare * B_q + deviation_q) +
                              to_q * (kPartialShare * B_p + deviation_p))
                  : 0};
}

double LinkOracle::cluster_error(NodeId p, NodeId q) const {
  const auto [to_p, to_q] = weights(p, q);
  const auto sent = [this](NodeId id) { return static_cast<double>(light_[id].B + light_[id].deviation); };
  return kClusterShare * largest_exchange(tree_, p, q) * (to_p * sent(q) + to_q * sent(p));
}

Halving LinkOracle::to_halve(NodeId p, NodeId q, const FacePair& pair, const LinkErrors& errors) const {
  const bool p_is_larger = tree_[p].shape.area >= tree_[q].shape.area;
  const double by_p = errors.by_p + (p_is_larger ? errors.by_shadow : 0);
  const double by_q = errors.by_q + (p_is_larger ? 0 : errors.by_shadow);
  return by_p >= by_q ? Halving{p, pair.p.edge} : Halving{q, pair.q.edge};
}

bool LinkOracle::is_settled(const Halving& next, const LinkErrors& errors) const {
  constexpr double kMinLength = 32;  // surface_epsilon: smaller faces are points for rays
  return errors.sum() <= 1 || tree_.edge_length(next.leaf, next.edge) < kMinLength * epsilon_;
}

bool LinkOracle::is_enough(const Link& link) const {
  if (tree_.is_cluster(link.p) || tree_.is_cluster(link.q)) return cluster_error(link.p, link.q) <= 1;
  // A little more than when it was made, so that rounding does not make it anew for ever.
  const double limit = 1.5 * (link.partial ? kRayShare : kFormFactorShare);
  if (static_cast<double>(link.G_error) * weight(link.p, link.q) > limit) return false;
  const FacePair pair = estimate_face_pair(tree_, link.p, link.q, epsilon_);
  const LinkErrors left = errors(link.p, link.q, pair, link.partial);
  return is_settled(to_halve(link.p, link.q, pair, left), left);
}

}  // namespace fluxel
