#pragma once

#include <algorithm>
#include <cmath>
#include <span>

#include "hierarchy/face_pair.hpp"
#include "hierarchy/link.hpp"
#include "hierarchy/node_light.hpp"
#include "hierarchy/node_tree.hpp"

namespace fluxel {

/// How fine links have to be.
struct RefinementGoal {
  /// Of the error that a link leaves in the radiosity of either node, as its root mean square over the
  /// scene's area, relative to the mean radiosity: what is wrong of the exchange times the radiosity that is
  /// sent (BF refinement, Hanrahan, Salzman & Aupperle 1991) and the importance of what receives it (Smits,
  /// Arvo & Salesin 1992).
  double error = 1e-3;
  double mean_radiosity = 0;  ///< [W/m2]
  bool settle = false;        ///< every pair is a link as it is, whatever error that leaves
  bool heat = false;  ///< what counts is what arrives, not what of it is reflected: also on black surfaces
};

/// What hardly reflects counts as if it reflected so much: else a lamp and what is beside its black back may
/// be one node that shines on that back, and the lamp's row sum, and the power that is absorbed, are wrong.
inline constexpr double kLeastReflectance = 0.05;

/// Parts of the allowed error that the form factor and the visible fraction may have.
inline constexpr double kFormFactorShare = 0.02, kRayShare = 0.3, kUnanimousShare = 2;

/// Errors that a link between faces leaves, over what is allowed, by the size of each node and by what stands
/// between.
struct LinkErrors {
  double by_p = 0, by_q = 0, by_shadow = 0;
  [[nodiscard]] double sum() const { return by_p + by_q + by_shadow; }
};

/// Estimates what error links leave, over what the goal allows. Tree and light outlive it.
class LinkOracle {
 public:
  /// `area` [m2]: of all faces; `epsilon` [m]: as for estimate_face_pair.
  LinkOracle(const NodeTree& tree, std::span<const NodeLight> light, const RefinementGoal& goal, double area,
             double epsilon);

  /// What an error of one unit of exchange area does to the worse of p and q, over what is allowed [1/m2].
  [[nodiscard]] double weight(NodeId p, NodeId q) const {
    const auto [to_p, to_q] = weights(p, q);
    return std::max(to_p * static_cast<double>(light_[q].B), to_q * static_cast<double>(light_[p].B));
  }
  /// `partial`: something stands between.
  [[nodiscard]] LinkErrors errors(NodeId p, NodeId q, const FacePair& pair, bool partial) const;
  /// Of two nodes of which one at least is a cluster.
  [[nodiscard]] double cluster_error(NodeId p, NodeId q) const;

  /// The face that most of the error comes from, along the edge that it changes over.
  [[nodiscard]] Halving to_halve(NodeId p, NodeId q, const FacePair& pair, const LinkErrors& errors) const;
  /// Whether the error is allowed, or the face to halve too small to be halved.
  [[nodiscard]] bool is_settled(const Halving& next, const LinkErrors& errors) const;
  /// Whether a link that has been made for another goal or other light leaves no more error than it may.
  [[nodiscard]] bool is_enough(const Link& link) const;

 private:
  struct Weights {
    double to_p, to_q;
  };
  /// What an error of one unit of radiosity times exchange area does to p and to q, over what is allowed.
  /// Asked of every pair that is looked at.
  [[nodiscard]] Weights weights(NodeId p, NodeId q) const { return {weight_at(p), weight_at(q)}; }
  [[nodiscard]] double weight_at(NodeId id) const {
    const NodeLight& light = light_[id];
    return (heat_ ? 1.0 : std::max(kLeastReflectance, static_cast<double>(light.rho))) *
           static_cast<double>(light.importance) / (std::sqrt(tree_[id].shape.area) * allowed_);
  }

  const NodeTree& tree_;
  std::span<const NodeLight> light_;
  bool heat_;
  double epsilon_;  // [m]
  double allowed_;  // of the error in a node's radiosity times the root of its area [W/m]
};

}  // namespace fluxel
