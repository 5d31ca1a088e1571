#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/element.hpp"
#include "core/ranks.hpp"
#include "solver/unknowns.hpp"

namespace fluxel {

/// Estimates how far a constant on each element is from the radiosity that varies over it: the area-weighted
/// root mean square of (B(x) - B_i), by the gradients between neighbours. With g the slope of B from an
/// element to the next of its patch and C the covariance of the element's points, the variance of a linear B
/// is grad' C grad, on average over directions g^2 trace C.
/// Neighbours are looked for in an element's own tile alone, so that each rank can estimate for the tiles
/// that it has. Elements that are alone there on their patch have no neighbour; they are left out.
class DiscretisationError {
 public:
  /// `unknowns` are those of `elements`, which are whole tiles of this rank. By all `ranks` together.
  DiscretisationError(std::span<const Element> elements, const Unknowns& unknowns, Ranks ranks = {});

  /// False where no element of any rank has a neighbour: then there is no estimate.
  [[nodiscard]] bool known() const { return known_; }

  /// For B of one channel or three [W/m2], an entry an unknown of this rank. By all ranks together.
  template <class Value>
  [[nodiscard]] Value estimate(std::span<const Value> B) const;

 private:
  /// Two unknowns that follow each other on a side of a patch.
  struct Link {
    std::uint32_t first, second;
    float weight;  ///< of the squared difference [m2]
  };

  Ranks ranks_;
  std::vector<Link> links_;
  bool known_ = false;
  double area_ = 0;  ///< of all ranks' elements with a neighbour [m2]
};

}  // namespace fluxel
