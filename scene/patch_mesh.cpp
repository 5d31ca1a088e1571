#include "scene/patch_mesh.hpp"

#include <OpenMesh/Core/Mesh/PolyConnectivity.hh>
#include <algorithm>
#include <array>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numeric>
#include <span>
#include <tuple>
#include <unordered_map>

#include "scene/contact_pairs.hpp"
#include "scene/polygon.hpp"

namespace fluxel {
namespace {

/// Half-edges alone: the points are the patches' own.
using Mesh = OpenMesh::PolyConnectivity;

/// Numbers corners in the order of their first use. A corner within the tolerance of earlier ones is the
/// lowest of these: a choice that later corners cannot change, so that equal corners always get the same
/// number.
class Welder {
 public:
  /// `points` takes the numbered corners and outlives the welder.
  Welder(double tolerance, std::vector<glm::dvec3>& points) : tolerance_(tolerance), points_(points) {}

  std::uint32_t vertex(const glm::dvec3& x) {
    const auto next = static_cast<std::uint32_t>(points_.size());
    std::uint32_t lowest = next;
    const Cell low = cell(x - tolerance_), high = cell(x + tolerance_);  // the same, for most
    for (std::int64_t i = low[0]; i <= high[0]; ++i) {
      for (std::int64_t j = low[1]; j <= high[1]; ++j) {
        for (std::int64_t k = low[2]; k <= high[2]; ++k) {
          const auto found = latest_.find({i, j, k});
          if (found == latest_.end()) continue;
          for (std::uint32_t vertex = found->second; vertex != kNone; vertex = before_[vertex]) {
            if (glm::distance(points_[vertex], x) <= tolerance_) lowest = std::min(lowest, vertex);
          }
        }
      }
    }
    if (lowest == next) {
      points_.push_back(x);
      std::uint32_t& latest = latest_.try_emplace(cell(x), kNone).first->second;
      before_.push_back(latest);
      latest = next;
    }
    return lowest;
  }

 private:
  using Cell = std::array<std::int64_t, 3>;
  struct CellHash {
    std::size_t operator()(const Cell& c) const {
      std::uint64_t hash = 0;
      for (const std::int64_t x : c) hash = (hash ^ static_cast<std::uint64_t>(x)) * 0x9E3779B97F4A7C15u;
      return hash ^ hash >> 32;
    }
  };
  [[nodiscard]] Cell cell(const glm::dvec3& x) const {
    const glm::dvec3 place = glm::floor(x / (32 * tolerance_));
    return {static_cast<std::int64_t>(place.x), static_cast<std::int64_t>(place.y),
            static_cast<std::int64_t>(place.z)};
  }

  static constexpr std::uint32_t kNone = 0xFFFFFFFFu;

  double tolerance_;
  std::vector<glm::dvec3>& points_;
  std::unordered_map<Cell, std::uint32_t, CellHash> latest_;  // point of a cell
  std::vector<std::uint32_t> before_;                         // of each point: the one before it in its cell
};

/// A half-edge mesh and, beside it, what its vertices and faces are.
struct HalfEdgeMesh {
  Mesh mesh;
  std::vector<std::uint32_t> welded;       ///< of each vertex: the number of its place
  std::vector<Mesh::VertexHandle> shared;  ///< of each place: the vertex that faces share

  Mesh::VertexHandle add_vertex(std::uint32_t place) {
    welded.push_back(place);
    return mesh.add_vertex();
  }
  [[nodiscard]] std::uint32_t place(Mesh::VertexHandle vertex) const {
    return welded[static_cast<std::size_t>(vertex.idx())];
  }

  /// What OpenMesh asks of a new face, asked before, for it says no on the error stream.
  [[nodiscard]] bool takes(const std::vector<Mesh::VertexHandle>& face) const {
    for (std::size_t i = 0; i < face.size(); ++i) {
      if (!mesh.is_boundary(face[i])) return false;
      for (std::size_t j = i + 1; j < face.size(); ++j) {
        if (face[i] == face[j]) return false;
      }
      const auto halfedge = mesh.find_halfedge(face[i], face[(i + 1) % face.size()]);
      if (halfedge.is_valid() && !mesh.is_boundary(halfedge)) return false;
    }
    return true;
  }

  void add_face(const Outline<std::uint32_t>& outline) {
    std::vector<Mesh::VertexHandle> face;
    for (std::size_t i = 0; i < outline.corners; ++i) {
      const std::uint32_t place = outline.corner[i];
      if (place == shared.size()) shared.push_back(add_vertex(place));
      face.push_back(shared[place]);
    }
    if (takes(face) && mesh.add_face(face).is_valid()) return;
    for (Mesh::VertexHandle& vertex : face) vertex = add_vertex(place(vertex));
    mesh.add_face(face);
  }
};

/// OpenMesh reports the rare face whose neighbours it cannot relink on the error stream: here it is an
/// answer.
class QuietOpenMesh {
 public:
  QuietOpenMesh() { ::omerr().disable(); }
  ~QuietOpenMesh() { ::omerr().enable(); }
  QuietOpenMesh(const QuietOpenMesh&) = delete;
  QuietOpenMesh& operator=(const QuietOpenMesh&) = delete;
};

/// A patch's use of the edge between two places.
struct EdgeUse {
  std::uint32_t low, high, patch;
  bool ascending;
};

std::vector<EdgeUse> edge_uses(const HalfEdgeMesh& held) {
  std::vector<EdgeUse> uses;
  for (const auto halfedge : held.mesh.halfedges()) {
    if (held.mesh.is_boundary(halfedge)) continue;
    const std::uint32_t from = held.place(held.mesh.from_vertex_handle(halfedge));
    const std::uint32_t to = held.place(held.mesh.to_vertex_handle(halfedge));
    if (from == to) continue;
    const auto patch = static_cast<std::uint32_t>(held.mesh.face_handle(halfedge).idx());
    uses.push_back({std::min(from, to), std::max(from, to), patch, from < to});
  }
  std::sort(uses.begin(), uses.end(), [](const EdgeUse& a, const EdgeUse& b) {
    return std::tie(a.low, a.high, a.patch, a.ascending) < std::tie(b.low, b.high, b.patch, b.ascending);
  });
  return uses;
}

/// Disjoint sets of patches; the lowest patch stands for its set.
struct Sets {
  explicit Sets(std::size_t size) : parent(size) { std::iota(parent.begin(), parent.end(), 0u); }
  std::uint32_t find(std::uint32_t x) {
    while (parent[x] != x) x = parent[x] = parent[parent[x]];
    return x;
  }
  void unite(std::uint32_t a, std::uint32_t b) {
    a = find(a);
    b = find(b);
    parent[std::max(a, b)] = std::min(a, b);
  }
  std::vector<std::uint32_t> parent;
};

/// Calls `visit` with the uses of each edge.
template <class Visit>
void for_each_edge(std::span<const EdgeUse> uses, const Visit& visit) {
  for (std::size_t first = 0; first < uses.size();) {
    std::size_t last = first + 1;
    while (last < uses.size() && uses[last].low == uses[first].low && uses[last].high == uses[first].high) {
      ++last;
    }
    visit(uses.subspan(first, last - first));
    first = last;
  }
}

}  // namespace

PatchMesh connect_patches(const Scene& scene) {
  PatchMesh result;
  HalfEdgeMesh held;
  Welder welder(contact_tolerance(scene), result.places);
  const QuietOpenMesh quiet;
  for (const Patch& patch : scene.patches) {
    Outline<std::uint32_t>& outline = result.outlines.emplace_back();
    for (const glm::dvec3& x : corners(patch.outline)) outline.corner[outline.corners++] = welder.vertex(x);
    held.add_face(outline);
  }
  const std::vector<EdgeUse> uses = edge_uses(held);

  Sets sets(scene.patches.size());
  for_each_edge(uses, [&](std::span<const EdgeUse> edge) {
    for (const EdgeUse& use : edge) sets.unite(edge[0].patch, use.patch);
  });
  result.component.resize(scene.patches.size());
  for (std::uint32_t patch = 0; patch < scene.patches.size(); ++patch) {
    const std::uint32_t lowest = sets.find(patch);
    if (lowest == patch) {
      result.component[patch] = static_cast<std::uint32_t>(result.components.size());
      result.components.emplace_back();
    } else {
      result.component[patch] = result.component[lowest];
    }
    result.components[result.component[patch]].patches.push_back(PatchId{patch});
  }
  for_each_edge(uses, [&](std::span<const EdgeUse> edge) {
    PatchComponent& component = result.components[result.component[edge[0].patch]];
    if (edge.size() == 1) {
      ++result.boundary_edges;
      component.closed = false;
    } else if (edge.size() > 2) {
      ++result.nonmanifold_edges;
      component.oriented = false;
    } else if (edge[0].ascending == edge[1].ascending) {
      ++result.flipped_edges;
      component.oriented = false;
    }
  });
  return result;
}

}  // namespace fluxel
