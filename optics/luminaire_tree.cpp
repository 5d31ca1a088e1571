#include "optics/luminaire_tree.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numeric>
#include <utility>

namespace fluxel {

namespace {

/// Luminaires of a group: it is drawn from by what each of them brings.
constexpr std::uint32_t kMostOfGroup = 8;

/// What is left of a number may round to 1, of which no half is drawn.
constexpr double kBelowOne = 0x1.fffffffffffffp-1;

}  // namespace

LuminaireTree::LuminaireTree(std::span<const LuminairePlace> luminaires) : order_(luminaires.size()) {
  std::iota(order_.begin(), order_.end(), 0);
  if (!order_.empty()) build(luminaires, 0, static_cast<std::uint32_t>(order_.size()));
}

std::uint32_t LuminaireTree::build(std::span<const LuminairePlace> luminaires, std::uint32_t first,
                                   std::uint32_t count) {
  const std::span<std::uint32_t> members = std::span(order_).subspan(first, count);
  Node node{luminaires[members.front()].low, luminaires[members.front()].high, 0, first, count, 0};
  for (const std::uint32_t k : members) {
    node.low = glm::min(node.low, luminaires[k].low);
    node.high = glm::max(node.high, luminaires[k].high);
    node.mean += luminaires[k].mean;
  }
  const auto at = static_cast<std::uint32_t>(nodes_.size());
  nodes_.push_back(node);
  if (count <= kMostOfGroup) return at;
  const glm::dvec3 extent = node.high - node.low;
  const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
  std::ranges::sort(members, {}, [&](std::uint32_t k) {
    return std::pair(luminaires[k].low[axis] + luminaires[k].high[axis], k);
  });
  build(luminaires, first, count / 2);
  const std::uint32_t second = build(luminaires, first + count / 2, count - count / 2);
  nodes_[at].second = second;
  return at;
}

double LuminaireTree::expected(const Node& node, const LitPlace& at) {
  const glm::dvec3 way = 0.5 * (node.low + node.high) - at.position, half = 0.5 * (node.high - node.low);
  const double along = glm::dot(way, at.normal) + glm::dot(half, glm::abs(at.normal));
  if (!(along > 0)) return 0;
  const double count = node.count, reach = glm::length(half);
  // One of them may be as near as the box is, all are about as far as its middle.
  const double apart = 0.5 * reach / count;
  const double near = std::hypot(glm::length(glm::max(glm::abs(way) - half, 0.0)), apart);
  const double far = std::hypot(glm::length(way), reach);
  const auto brought = [&](double distance) {
    return std::min(along, distance) / (distance * distance * distance);
  };
  return node.mean * (brought(near) / count + brought(far));
}

LuminaireTree::Group LuminaireTree::draw(const LitPlace& at, double choice) const {
  if (nodes_.empty()) return {};
  std::uint32_t number = 0;
  double chance = 1;
  while (nodes_[number].second != 0) {
    const double one = expected(nodes_[number + 1], at), other = expected(nodes_[nodes_[number].second], at);
    if (!(one + other > 0)) return {};
    const double share = one / (one + other);
    if (choice < share) {
      number = number + 1;
      chance *= share;
      choice /= share;
    } else {
      number = nodes_[number].second;
      chance *= 1 - share;
      choice = (choice - share) / (1 - share);
    }
    choice = std::min(choice, kBelowOne);
  }
  const Node& group = nodes_[number];
  return {std::span(order_).subspan(group.first, group.count), chance, choice};
}

}  // namespace fluxel
