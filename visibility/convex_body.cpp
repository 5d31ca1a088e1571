#include "visibility/convex_body.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <map>
#include <optional>
#include <utility>

#include "scene/polygon.hpp"

namespace fluxel {

namespace {

using Corner = std::uint32_t;  // equal coordinates, equal number
using Edge = std::pair<Corner, Corner>;

/// Faces that meet at a sharper angle than this cosine are not looked at as a body: what rounding does to
/// their planes would move their edge.
constexpr double kSharpest = -0.9;

/// A convex polygon of one plane, counter-clockwise.
struct Region {
  std::vector<Corner> corner;
  glm::dvec3 normal{0};
};

/// Joins patches that share whole edges, with the same two corners to the last digit: with nothing between
/// them a line cannot slip through. What counts as one plane, as straight and as convex is so within the
/// rounding of coordinates in double precision, which single precision cannot see.
class BodyFinder {
 public:
  explicit BodyFinder(const Scene& scene) : scene_(scene), rounding_(16 * 0x1p-53 * scene.extent) {}

  std::vector<std::vector<Region>> find() {
    number_corners();
    merge_regions();
    return join_bodies();
  }

  [[nodiscard]] const glm::dvec3& place(Corner corner) const { return place_[corner]; }

 private:
  static constexpr std::uint32_t kNone = ~0u;

  void number_corners() {
    std::map<std::array<double, 3>, Corner> numbers;
    for (const Patch& patch : scene_.patches) {
      Region& region = regions_.emplace_back();
      region.normal = patch.normal;
      for (const glm::dvec3& x : corners(patch.outline)) {
        const auto [at, added] = numbers.try_emplace({x.x, x.y, x.z}, static_cast<Corner>(place_.size()));
        if (added) place_.push_back(x);
        region.corner.push_back(at->second);
      }
    }
  }

  /// Which region runs along each directed edge; kNone for more than one.
  [[nodiscard]] std::map<Edge, std::uint32_t> edge_users() const {
    std::map<Edge, std::uint32_t> users;
    for (std::uint32_t r = 0; r < regions_.size(); ++r) {
      const std::vector<Corner>& corner = regions_[r].corner;
      for (std::size_t k = 0; k < corner.size(); ++k) {
        const auto [at, added] = users.try_emplace({corner[k], corner[(k + 1) % corner.size()]}, r);
        if (!added) at->second = kNone;
      }
    }
    return users;
  }

  [[nodiscard]] double height(const Region& over, Corner corner) const {
    return glm::dot(over.normal, place_[corner] - place_[over.corner[0]]);
  }

  [[nodiscard]] bool lies_in_plane(const Region& region, const Region& other) const {
    // Normals that differ by less than planes of single precision do, as far as the scene reaches.
    constexpr double kSameNormal = 1e-8;
    return glm::length(region.normal - other.normal) <= kSameNormal &&
           std::ranges::all_of(other.corner,
                               [&](Corner c) { return std::abs(height(region, c)) <= rounding_; });
  }

  /// The outline of two regions on both sides of the edge, without corners where it goes straight on; none
  /// where it is not convex or has too many.
  [[nodiscard]] std::optional<std::vector<Corner>> joined(const Region& a, const Region& b,
                                                          const Edge& edge) const {
    std::vector<Corner> outline;
    const auto append = [&outline](const Region& region, Corner first, Corner last) {
      const auto at = std::ranges::find(region.corner, first);
      auto k = static_cast<std::size_t>(at - region.corner.begin());
      for (; region.corner[k] != last; k = (k + 1) % region.corner.size())
        outline.push_back(region.corner[k]);
    };
    append(a, edge.second, edge.first);
    append(b, edge.first, edge.second);
    std::vector<Corner> kept;
    for (std::size_t k = 0; k < outline.size(); ++k) {
      const glm::dvec3& last = place_[outline[(k + outline.size() - 1) % outline.size()]];
      const glm::dvec3& next = place_[outline[(k + 1) % outline.size()]];
      const glm::dvec3 base = next - last;
      const double off = glm::dot(a.normal, glm::cross(place_[outline[k]] - last, base));
      if (off < -rounding_ * glm::length(base)) return std::nullopt;
      if (off <= rounding_ * glm::length(base)) {
        if (glm::dot(place_[outline[k]] - last, next - place_[outline[k]]) <= 0) return std::nullopt;
        continue;
      }
      kept.push_back(outline[k]);
    }
    if (kept.size() < 3 || kept.size() > ConvexBody::kMaxCorners) return std::nullopt;
    return kept;
  }

  void merge_regions() {
    for (bool merged = true; merged;) {
      merged = false;
      const std::map<Edge, std::uint32_t> users = edge_users();
      std::vector<bool> changed(regions_.size(), false);
      for (const auto& [edge, a] : users) {
        const auto opposite = users.find({edge.second, edge.first});
        if (a == kNone || opposite == users.end() || opposite->second == kNone) continue;
        const std::uint32_t b = opposite->second;
        if (a >= b || changed[a] || changed[b] || !lies_in_plane(regions_[a], regions_[b]) ||
            !lies_in_plane(regions_[b], regions_[a]))
          continue;
        if (auto outline = joined(regions_[a], regions_[b], edge)) {
          regions_[a].corner = std::move(*outline);
          regions_[b].corner.clear();
          changed[a] = changed[b] = merged = true;
        }
      }
      std::erase_if(regions_, [](const Region& region) { return region.corner.empty(); });
    }
  }

  /// Whether the regions are the closed surface of a convex body, seen from outside.
  [[nodiscard]] bool are_convex(std::span<const Region> faces) const {
    for (const Region& face : faces) {
      for (const Region& other : faces) {
        const bool same = &face == &other;
        if (!same && glm::dot(face.normal, other.normal) < kSharpest && share_corner(face, other))
          return false;
        for (const Corner corner : other.corner) {
          const double above = height(face, corner);
          if (above > rounding_ || (same && above < -rounding_)) return false;
        }
      }
    }
    return true;
  }

  [[nodiscard]] static bool share_corner(const Region& a, const Region& b) {
    return std::ranges::any_of(a.corner,
                               [&](Corner c) { return std::ranges::find(b.corner, c) != b.corner.end(); });
  }

  std::vector<std::vector<Region>> join_bodies() const {
    const std::map<Edge, std::uint32_t> users = edge_users();
    std::vector<std::vector<Region>> bodies;
    std::vector<bool> met(regions_.size(), false);
    for (std::uint32_t seed = 0; seed < regions_.size(); ++seed) {
      if (met[seed]) continue;
      std::vector<std::uint32_t> component{seed};
      met[seed] = true;
      bool closed = true;
      std::size_t edges = 0;
      for (std::size_t i = 0; i < component.size(); ++i) {
        const std::vector<Corner>& corner = regions_[component[i]].corner;
        edges += corner.size();
        for (std::size_t k = 0; k < corner.size(); ++k) {
          const Edge edge{corner[k], corner[(k + 1) % corner.size()]};
          const auto opposite = users.find({edge.second, edge.first});
          if (users.at(edge) == kNone || opposite == users.end() || opposite->second == kNone) {
            closed = false;
          } else if (!met[opposite->second]) {
            met[opposite->second] = true;
            component.push_back(opposite->second);
          }
        }
      }
      std::vector<Region> faces;
      faces.reserve(component.size());
      for (const std::uint32_t r : component) faces.push_back(regions_[r]);
      if (closed && faces.size() >= 4 && faces.size() <= ConvexBody::kMaxFaces &&
          edges <= 2 * ConvexBody::kMaxEdges && are_convex(faces)) {
        bodies.push_back(std::move(faces));
      } else {
        for (Region& face : faces) bodies.push_back({std::move(face)});
      }
    }
    return bodies;
  }

  const Scene& scene_;
  double rounding_;  // [m]
  std::vector<glm::dvec3> place_;
  std::vector<Region> regions_;
};

/// Faces whose surface is closed, or a single one.
class BodyMaker {
 public:
  BodyMaker(const BodyFinder& finder, const std::vector<Region>& faces) : finder_(finder) {
    for (const Region& face : faces) add_face(face);
    const bool flat = faces.size() == 1;
    body_.planes = static_cast<std::uint32_t>(faces.size());
    body_.faces = flat ? 2 : body_.planes;
    std::map<Edge, std::uint32_t> numbers;
    for (std::uint32_t f = 0; f < faces.size(); ++f) {
      const std::vector<Corner>& corner = faces[f].corner;
      for (std::size_t k = 0; k < corner.size(); ++k) {
        const Edge edge{corner[k], corner[(k + 1) % corner.size()]};
        if (const auto at = numbers.find({edge.second, edge.first}); at != numbers.end()) {
          body_.right[f] |= 1u << at->second;
          continue;
        }
        const std::uint32_t number = body_.edges++;
        numbers.emplace(edge, number);
        set(body_.from, number, edge.first);
        set(body_.to, number, edge.second);
        body_.left[f] |= 1u << number;
        if (flat) body_.right[1] |= 1u << number;
      }
    }
    finish_corners();
  }

  /// False where it has too many corners.
  [[nodiscard]] bool fits() const { return corners_.size() <= ConvexBody::kMaxCorners; }

  [[nodiscard]] const ConvexBody& body() const { return body_; }
  [[nodiscard]] const BoxTree::Box& box() const { return box_; }

 private:
  void add_face(const Region& face) {
    const std::size_t k = body_.planes++;
    body_.base[k] = glm::vec3(finder_.place(face.corner[0]));
    body_.normal[k] = glm::vec3(face.normal);
    Polygon outline;
    for (const Corner corner : face.corner) outline.push_back(finder_.place(corner));
    body_.breadth = std::max(body_.breadth, static_cast<float>(0.5 * std::sqrt(area(outline))));
    for (const Corner corner : face.corner)
      if (std::ranges::find(corners_, corner) == corners_.end()) corners_.push_back(corner);
  }

  void set(ConvexBody::Ends& ends, std::uint32_t edge, Corner corner) {
    const glm::vec3 x(finder_.place(corner));
    ends.x[edge] = x.x, ends.y[edge] = x.y, ends.z[edge] = x.z;
  }

  void finish_corners() {
    if (!fits()) return;
    glm::dvec3 low = finder_.place(corners_[0]), high = low, middle(0);
    for (const Corner corner : corners_) {
      const glm::dvec3& x = finder_.place(corner);
      low = glm::min(low, x), high = glm::max(high, x);
      middle += x / static_cast<double>(corners_.size());
      body_.corner[body_.corners++] = glm::vec3(x);
    }
    body_.centre = glm::vec3(middle);
    for (std::uint32_t k = 0; k < body_.corners; ++k)
      body_.radius = std::max(body_.radius, glm::length(body_.corner[k] - body_.centre));
    box_ = {{low.x, low.y, low.z}, {high.x, high.y, high.z}};
  }

  const BodyFinder& finder_;
  ConvexBody body_;
  std::vector<Corner> corners_;
  BoxTree::Box box_{};
};

glm::vec3 rounded(const BoxTree::Point& x) { return glm::vec3(glm::dvec3(x[0], x[1], x[2])); }

}  // namespace

BodyTree::BodyTree(const Scene& scene) {
  std::vector<ConvexBody> bodies;
  std::vector<BoxTree::Box> boxes;
  const auto add = [&](const BodyMaker& maker) {
    bodies.push_back(maker.body());
    boxes.push_back(maker.box());
  };
  BodyFinder finder(scene);
  for (const std::vector<Region>& faces : finder.find()) {
    if (const BodyMaker whole(finder, faces); whole.fits()) {
      add(whole);
    } else {
      for (const Region& face : faces) add(BodyMaker(finder, {face}));
    }
  }
  const BoxTree tree(boxes);
  bodies_.reserve(bodies.size());
  for (const std::uint32_t item : tree.order) bodies_.push_back(bodies[item]);
  nodes_.reserve(tree.nodes.size());
  for (const BoxTree::Node& node : tree.nodes)
    nodes_.push_back({rounded(node.box.low), rounded(node.box.high), node.first, node.count});
}

}  // namespace fluxel
