#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "core/ranks.hpp"
#include "hierarchy/ray_row.hpp"
#include "solver/radiosity_operator.hpp"
#include "solver/unknowns.hpp"

namespace fluxel {

/// F as rays have it, times the reflectance of what they end on: from the irradiance of a cut to what that
/// becomes there once it has been reflected. So its size is that of the cut, and not of the tree below. A row
/// is on one rank and summed by one thread, so that the result has the same bytes for every number of them.
/// No row sum is above the largest reflectance.
class RayOperator final : public RadiosityOperator {
 public:
  /// All must outlive this. `rows` are this rank's, in the order of the cut.
  RayOperator(const NodeTree& tree, const TreeCut& cut, std::span<const RayRow> rows, const Ranks& ranks,
              int threads);

  [[nodiscard]] bool is_grey() const override;
  void apply(std::span<const Rgb> x, std::span<Rgb> H) override;
  void apply(std::span<const double> x, std::span<double> H) override;
  void sweep(std::span<const Rgb> E, std::span<const Rgb> rho, std::span<Rgb> x) override;
  void sweep(std::span<const double> E, std::span<const double> rho, std::span<double> x) override;

  /// H = D + F H as a system of B = E + rho F B: with D, the irradiance of the cut by emission, as what is
  /// emitted, and no reflectance beside the operator's own.
  [[nodiscard]] Unknowns system() const;
  /// The irradiance of the cut by what leaves send [W/m2] and reflect.
  [[nodiscard]] std::vector<Rgb> reflected(const std::function<double(NodeId)>& sent) const;
  /// Of each unknown, the part of its rays that end on a leaf.
  [[nodiscard]] std::vector<double> row_sums() const;

 private:
  /// What a ray ends on, and where its light comes from.
  struct Sender {
    std::uint32_t row = 0, material = 0;
    glm::vec3 normal{0};
  };
  template <class Value>
  void apply_to(std::span<const Value> x, std::span<Value> H) const;
  template <class Value>
  void sweep_over(std::span<const Value> E, std::span<const Value> rho, std::span<Value> x) const;
  /// The mean over the rays of each unknown of what `value` gives for a ray's number among this rank's and
  /// its end.
  template <class Value, class Function>
  [[nodiscard]] std::vector<Value> means(const Function& value) const;
  /// From the unknowns of this rank's rows to all.
  template <class Value>
  [[nodiscard]] std::vector<Value> of_all(std::span<const Value> own) const;

  const NodeTree& tree_;
  const TreeCut& cut_;
  std::span<const RayRow> rows_;
  const Ranks& ranks_;
  int threads_;
  std::vector<std::size_t> first_end_, first_own_;  // of each row: among this rank's rays, and unknowns
  std::vector<Sender> senders_;                     // of the rays
  std::vector<double> largest_rho_;                 // of the materials
};

}  // namespace fluxel
