#pragma once

// Portable: what a device's compiler takes too (see visibility/cuda/portable.hpp).

#include <cstddef>
#include <utility>

#include "octree/octree_arrays.hpp"
#include "octree/octree_passes.hpp"

namespace fluxel {

/// Builds an octree of references level by level, by passes over all references and cubes of a level (Frolov
/// et al. 2014), so that the tree is the same byte by byte whatever runs them. `Machine` does, and has
///   Array<T>, with data();
///   array<T>(n), whose contents need not be set; grow(array, n), which keeps what it holds;
///   for_each(n, pass): pass(k) for all k < n;
///   sum_before(array, n): of each value the sum of those before it; returns the sum of all;
///   sort(array, n, cubes): references by their cubes, of which there are so many; spheres of a cube are
///   ascending before and stay so.
template <class Machine>
class OctreeBuilder {
 public:
  template <class T>
  using Array = typename Machine::template Array<T>;

  /// The spheres lie where the machine's passes can read them, and must outlive this.
  OctreeBuilder(Machine& machine, const Sphere* spheres, std::size_t count, const OctreeFrame& frame)
      : machine_(machine) {
    at_.frame = frame.view(nullptr, nullptr);
    at_.spheres = spheres;
    begin_level(machine_.template array<OctreeCube>(1), 1, machine_.template array<OctreeReference>(count),
                count);
    machine_.for_each(1, octree_pass::AddRoot{at_});
    machine_.for_each(count, octree_pass::Open{at_});
    find_ranges();
  }

  void build() {
    for (at_.level = 0; at_.cube_count > 0; ++at_.level) {
      test();
      const std::uint32_t divided = divide();
      append(divided);
    }
  }

  [[nodiscard]] Array<OctreeNode>& nodes() { return nodes_; }
  [[nodiscard]] std::size_t node_count() const { return node_count_; }
  [[nodiscard]] Array<std::uint32_t>& references() { return references_; }
  [[nodiscard]] std::size_t reference_count() const { return reference_count_; }

 private:
  /// Nodes for these cubes, and their references.
  void begin_level(Array<OctreeCube>&& cubes, std::size_t cube_count, Array<OctreeReference>&& open,
                   std::size_t open_count) {
    cubes_ = std::move(cubes);
    open_ = std::move(open);
    at_.cubes = cubes_.data();
    at_.open = open_.data();
    at_.cube_count = cube_count;
    at_.open_count = open_count;
    at_.first_node = static_cast<std::uint32_t>(node_count_);
    node_count_ += cube_count;
    at_.next_node = static_cast<std::uint32_t>(node_count_);
    machine_.grow(nodes_, node_count_);
    at_.nodes = nodes_.data();
  }

  void find_ranges() {
    machine_.for_each(at_.open_count, octree_pass::BeginCubes{at_});
    machine_.for_each(at_.open_count, octree_pass::EndCubes{at_});
  }

  void test() {
    met_ = machine_.template array<std::uint8_t>(at_.open_count);
    at_.met = met_.data();
    auto growth = machine_.template array<std::uint64_t>(at_.open_count);
    at_.growth = growth.data();
    machine_.for_each(at_.open_count, octree_pass::Test{at_});
    at_.grown = machine_.sum_before(growth, at_.open_count);
    divided_ = machine_.template array<std::uint8_t>(at_.cube_count);
    rank_ = machine_.template array<std::uint32_t>(at_.cube_count);
    kept_ = machine_.template array<std::uint32_t>(at_.cube_count);
    at_.divided = divided_.data();
    at_.rank = rank_.data();
    at_.kept = kept_.data();
    machine_.for_each(at_.cube_count, octree_pass::Divide{at_});
  }

  /// Writes nodes, and the references of leaves. Returns how many cubes are divided.
  [[nodiscard]] std::uint32_t divide() {
    const std::uint32_t divided = machine_.sum_before(rank_, at_.cube_count);
    const std::uint32_t kept = machine_.sum_before(kept_, at_.cube_count);
    at_.first_kept = static_cast<std::uint32_t>(reference_count_);
    reference_count_ += kept;
    machine_.grow(references_, reference_count_);
    at_.references = references_.data();
    machine_.for_each(at_.cube_count, octree_pass::MakeNode{at_});
    machine_.for_each(at_.open_count, octree_pass::Keep{at_});
    return divided;
  }

  /// Children of what is divided, with their references.
  void append(std::uint32_t divided) {
    auto place = machine_.template array<std::uint32_t>(at_.open_count);
    at_.place = place.data();
    machine_.for_each(at_.open_count, octree_pass::Place{at_});
    const std::uint32_t count = machine_.sum_before(place, at_.open_count);
    auto next = machine_.template array<OctreeReference>(count);
    at_.next = next.data();
    machine_.for_each(at_.open_count, octree_pass::Append{at_});
    const std::size_t cubes = std::size_t{8} * divided;
    machine_.sort(next, count, cubes);
    auto children = machine_.template array<OctreeCube>(cubes);
    at_.children = children.data();
    machine_.for_each(at_.cube_count, octree_pass::AddChildren{at_});
    begin_level(std::move(children), cubes, std::move(next), count);
    find_ranges();
  }

  Machine& machine_;
  OctreeLevel at_{};
  Array<OctreeCube> cubes_;
  Array<OctreeReference> open_;
  Array<std::uint8_t> met_, divided_;
  Array<std::uint32_t> rank_, kept_;
  Array<OctreeNode> nodes_;
  Array<std::uint32_t> references_;
  std::size_t node_count_ = 0, reference_count_ = 0;
};

}  // namespace fluxel
