#include "hierarchy/node_tree.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "core/reserve_more.hpp"
#include "hierarchy/cluster_builder.hpp"
#include "subdivision/add_element.hpp"
#include "subdivision/bisection.hpp"

namespace fluxel {

namespace {

double radius_around(const glm::dvec3& centre, const Outline3& outline) {
  double radius = 0;
  for (std::uint32_t c = 0; c < outline.corners; ++c)
    radius = std::max(radius, glm::distance(centre, outline.corner[c]));
  return radius;
}

glm::dvec2 extent_around(const glm::dvec3& centre, const Outline3& outline, const PlaneAxes& axes) {
  glm::dvec2 extent(0);
  for (std::uint32_t c = 0; c < outline.corners; ++c) {
    const glm::dvec3 d = outline.corner[c] - centre;
    extent = glm::max(extent, glm::abs(glm::dvec2(glm::dot(d, axes.u), glm::dot(d, axes.v))));
  }
  return extent;
}

/// Makes a cluster of two nodes.
void enclose(const Node& a, const Node& b, Node& node) {
  node.shape.area = a.shape.area + b.shape.area;
  const double share = b.shape.area / node.shape.area;
  const glm::dvec3 between = b.shape.centroid - a.shape.centroid;
  node.shape.centroid = a.shape.centroid + share * between;
  node.shape.normal = (1 - share) * a.shape.normal + share * b.shape.normal;
  // A round cluster has a third of its mean squared distance along each axis; what is asked of is the trace
  // alone.
  node.shape.moments.minor_variance =
      0.5 * ((1 - share) * a.shape.moments.trace() + share * b.shape.moments.trace() +
             share * (1 - share) * glm::dot(between, between));
  node.radius = std::max(glm::distance(node.shape.centroid, a.shape.centroid) + a.radius,
                         glm::distance(node.shape.centroid, b.shape.centroid) + b.radius);
}

}  // namespace

WayParts way_parts(const glm::dvec3& direction) {
  const glm::dvec3 squares = direction * direction;
  const double sum = glm::dot(squares, squares);
  WayParts parts;
  if (!(sum > 0)) return parts;
  for (int axis = 0; axis < 3; ++axis) {
    const auto k = static_cast<std::size_t>(axis);
    parts.way[k] = 2 * k + (direction[axis] < 0 ? 1 : 0);
    parts.part[k] = squares[axis] * squares[axis] / sum;
  }
  return parts;
}

NodeTree::NodeTree(const Scene& scene, int threads, const Ranks& ranks) : scene_(scene), threads_(threads) {
  if (ranks.leads_host) build();
  ranks.share(nodes_);
  ranks.share(line_of_);
  ranks.share(axes_);
  ranks.share(faces_);
  ranks.share(cones_);
  ranks.share(ordered_faces_);
  ranks.share(ranges_);
  whole_ = nodes_.size();
  clusters_ = ranges_.size();
}

void NodeTree::build() {
  std::size_t faces = 0;
  for (const Piece& piece : scene_.pieces)
    faces += static_cast<std::size_t>(std::popcount(scene_.patch(piece.patch).sides));
  // With the clusters, and the first halves: to move all nodes for these takes longer than to make them.
  nodes_.reserve(2 * faces + 2 * faces / Ranks::kRoom);
  axes_.reserve(scene_.pieces.size());
  faces_.assign(2 * scene_.pieces.size(), kNoNode);
  for (std::size_t piece = 0; piece < scene_.pieces.size(); ++piece)
    add_faces_of(static_cast<std::uint32_t>(piece));
  add_clusters();
  line_of_.reserve(nodes_.capacity());
  line_of_.assign(nodes_.size(), kNoLine);
}

void NodeTree::add_face(const Outline3& outline, std::uint32_t piece, bool front, NodeId parent) {
  Node node;
  const glm::dvec3& normal = scene_.patch(scene_.pieces[piece].patch).normal;
  node.shape = {fluxel::centroid(outline), front ? normal : -normal, fluxel::area(outline),
                second_moments(outline)};
  node.radius = radius_around(node.shape.centroid, outline);
  node.extent = extent_around(node.shape.centroid, outline, axes_[piece]);
  node.parent = parent;
  node.piece = piece;
  node.front = front;
  nodes_.push_back(node);
}

NodeId NodeTree::add_half(const Outline3& outline, std::uint32_t piece, bool front, NodeId parent) {
  add_face(outline, piece, front, parent);
  outlines_.push_back(outline);
  return static_cast<NodeId>(nodes_.size() - 1);
}

void NodeTree::add_faces_of(std::uint32_t piece) {
  const Outline3& outline = scene_.pieces[piece].outline;
  const std::uint32_t sides = scene_.patch(scene_.pieces[piece].patch).sides;
  const glm::dvec3 u = glm::normalize(outline.corner[1] - outline.corner[0]);
  axes_.push_back({u, glm::cross(scene_.patch(scene_.pieces[piece].patch).normal, u)});
  const auto add = [&](std::uint32_t side, const Outline3& of_side) {
    if ((sides & side) == 0) return kNoNode;
    add_face(of_side, piece, side == kFront, kNoNode);
    return static_cast<NodeId>(nodes_.size() - 1);
  };
  const NodeId front = add(kFront, outline), back = add(kBack, reversed(outline));
  faces_[2 * std::size_t{piece}] = front;
  faces_[2 * std::size_t{piece} + 1] = back;
  if (front == kNoNode || back == kNoNode) return;
  nodes_[front].twin = back;
  nodes_[back].twin = front;
}

/// Puts the clusters before the faces, whose numbers grow by theirs.
void NodeTree::add_clusters() {
  const ClusterTree tree = build_cluster_tree(nodes_, threads_);
  clusters_ = tree.clusters.size();
  const auto moved = static_cast<NodeId>(clusters_);
  for (NodeId& face : faces_)
    if (face != kNoNode) face += moved;
  for (Node& face : nodes_)
    if (face.twin != kNoNode) face.twin += moved;
  nodes_.insert(nodes_.begin(), clusters_, Node{});
  cones_.resize(clusters_);
  ranges_.resize(clusters_);
  ordered_faces_ = tree.faces;
  for (NodeId& face : ordered_faces_) face += moved;
  for (std::size_t id = clusters_; id-- > 0;) {
    const ClusterTree::Cluster& cluster = tree.clusters[id];
    Node& node = nodes_[id];
    for (std::size_t k = 0; k < 2; ++k) {
      const std::uint32_t child = cluster.child[k];
      node.child[k] = (child & ClusterTree::kFace) != 0 ? (child - ClusterTree::kFace) + moved : child;
      nodes_[node.child[k]].parent = static_cast<NodeId>(id);
    }
    enclose(nodes_[node.child[0]], nodes_[node.child[1]], node);
    cones_[id] = cluster.cone;
    ranges_[id] = {cluster.first, cluster.last - cluster.first};
  }
}

NodeId NodeTree::random_face(NodeId id, double& u) const {
  while (is_cluster(id)) {
    const auto [a, b] = nodes_[id].child;
    const double share = nodes_[a].shape.area / nodes_[id].shape.area;
    const bool first = u < share;
    u = first ? u / share : (u - share) / (1 - share);
    id = first ? a : b;
  }
  u = std::clamp(u, 0.0, std::nextafter(1.0, 0.0));
  return id;
}

DrawnFace NodeTree::draw_face(NodeId id, const glm::dvec3& from, double& u) const {
  const auto size = [&](NodeId node) {
    const glm::dvec3 d = nodes_[node].shape.centroid - from;
    const double reach = 0.5 * nodes_[node].radius;
    return nodes_[node].shape.area / std::max(glm::dot(d, d), reach * reach);
  };
  double chance = 1;
  while (is_cluster(id)) {
    const auto [a, b] = nodes_[id].child;
    const double of_a = size(a), share = of_a / (of_a + size(b));
    const bool first = u < share;
    u = first ? u / share : (u - share) / (1 - share);
    chance *= first ? share : 1 - share;
    id = first ? a : b;
  }
  u = std::clamp(u, 0.0, std::nextafter(1.0, 0.0));
  return {id, chance};
}

void NodeTree::split(std::span<const Halving> leaves) {
  make_room(leaves.size());
  for (const auto& [id, edge] : leaves) {
    if (!nodes_[id].is_leaf()) continue;  // as a twin
    halve(id, edge);
  }
}

std::vector<Halving> NodeTree::halvings() const {
  std::vector<Halving> halved;
  // A halving has added two nodes, the parent's children, and two more behind them for its twin's.
  for (std::size_t id = whole_; id < nodes_.size(); id += nodes_[id].twin != kNoNode ? 4 : 2)
    halved.push_back({nodes_[id].parent, nodes_[nodes_[id].parent].halved});
  return halved;
}

/// For the halves of so many leaves and their twins.
void NodeTree::make_room(std::size_t halvings) {
  constexpr std::size_t kMost = 4;
  reserve_more(nodes_, kMost * halvings);
  reserve_more(outlines_, kMost * halvings);
  reserve_more(line_of_, kMost * halvings);
}

bool NodeTree::halve_again(std::span<const Halving> halvings) {
  make_room(halvings.size());
  for (const auto& [id, edge] : halvings) {
    if (id >= nodes_.size() || is_cluster(id) || !nodes_[id].is_leaf()) return false;
    if (edge >= (outline(id).corners == 4 ? 2 : 3)) return false;
    halve(id, edge);
  }
  return true;
}

/// Both sides at once, the back's halves being the front's.
void NodeTree::halve(NodeId id, std::uint32_t edge) {
  if (!nodes_[id].front && nodes_[id].twin != kNoNode) id = nodes_[id].twin;
  const Node node = nodes_[id];
  const auto turned = [&node](const Outline3& part) { return node.front ? part : reversed(part); };
  const auto [first, second] = bisect(front_outline(id), edge);
  const HalfPlane in_first = first_half(first.corner[1], first.corner[2],
                                        (node.front ? 2 : -2) * node.shape.area * node.shape.normal);
  const auto divide = [&](NodeId of, NodeId a, NodeId b) {
    nodes_[of].halved = static_cast<std::uint8_t>(edge);
    nodes_[of].child = {a, b};
    line_of_[of] = static_cast<std::uint32_t>(lines_.size());
    lines_.push_back({in_first, {a, b}});
    line_of_.resize(nodes_.size(), kNoLine);
  };
  const NodeId a = add_half(turned(first), node.piece, node.front, id);
  const NodeId b = add_half(turned(second), node.piece, node.front, id);
  divide(id, a, b);
  if (node.twin == kNoNode) return;
  const NodeId c = add_half(reversed(first), node.piece, !node.front, node.twin);
  const NodeId d = add_half(reversed(second), node.piece, !node.front, node.twin);
  divide(node.twin, c, d);
  nodes_[a].twin = c, nodes_[c].twin = a;
  nodes_[b].twin = d, nodes_[d].twin = b;
}

glm::dmat2 NodeTree::covariance(NodeId id) const {
  const Node& node = nodes_[id];
  const glm::dvec3& elongation = node.shape.moments.elongation;
  const glm::dvec2 e = along_axes(id, elongation);
  const glm::dmat2 squares = glm::dmat2(node.shape.moments.minor_variance) + glm::outerProduct(e, e);
  return glm::matrixCompMult(squares, 1.0 / glm::outerProduct(node.extent, node.extent));
}

Outline3 NodeTree::front_outline(NodeId id) const {
  return nodes_[id].front ? outline(id) : reversed(outline(id));
}

template <class Visit>
void NodeTree::visit_parts(const Visit& visit) const {
  std::vector<NodeId> open;
  for (std::size_t piece = 0; piece < scene_.pieces.size(); ++piece) {
    const NodeId front = face(piece, true), root = front != kNoNode ? front : face(piece, false);
    if (root == kNoNode) {
      visit(piece, kNoNode);
      continue;
    }
    open.push_back(root);
    while (!open.empty()) {
      const NodeId id = open.back();
      open.pop_back();
      if (nodes_[id].is_leaf()) {
        visit(piece, id);
        continue;
      }
      open.push_back(nodes_[id].child[1]);
      open.push_back(nodes_[id].child[0]);
    }
  }
}

ElementMesh NodeTree::elements() const {
  struct Part {
    std::size_t piece;
    NodeId id;
  };
  std::vector<Part> parts;
  visit_parts([&parts](std::size_t piece, NodeId id) { parts.push_back({piece, id}); });
  ElementMesh mesh{std::vector<Element>(parts.size()), std::vector<Outline<glm::vec3>>(parts.size())};
  tbb::task_arena arena(threads_);
  arena.execute([&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, parts.size(), 1024), [&](const auto& range) {
      for (std::size_t k = range.begin(); k < range.end(); ++k) {
        const auto [piece, id] = parts[k];
        const Outline3 outline = id == kNoNode ? scene_.pieces[piece].outline : front_outline(id);
        mesh.elements[k] = make_element(scene_, scene_.pieces[piece].patch, outline);
        mesh.outlines[k] = narrow(outline);
      }
    });
  });
  return mesh;
}

std::vector<ElementNodes> NodeTree::element_nodes() const {
  std::vector<ElementNodes> nodes;
  visit_parts([&](std::size_t, NodeId id) {
    const NodeId twin = id == kNoNode ? kNoNode : nodes_[id].twin;
    nodes.push_back(id != kNoNode && !nodes_[id].front ? ElementNodes{twin, id} : ElementNodes{id, twin});
  });
  return nodes;
}

NodeId NodeTree::leaf_below(NodeId face, const glm::dvec3& point) const {
  if (face == kNoNode) return kNoNode;
  for (std::uint32_t line; (line = line_of_[face]) != kNoLine;)
    face = lines_[line].child[lines_[line].first.holds(point) ? 0 : 1];
  return face;
}

}  // namespace fluxel
