#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "scene/polygon.hpp"
#include "scene/scene.hpp"

namespace fluxel {

/// Pieces that points are drawn over evenly.
class PieceDraw {
 public:
  /// The piece must outlive this.
  void add(const Piece& piece) {
    pieces_.push_back(&piece);
    ends_.push_back(area() + fluxel::area(corners(piece.outline)));
  }

  [[nodiscard]] bool empty() const { return pieces_.empty(); }
  [[nodiscard]] double area() const { return ends_.empty() ? 0 : ends_.back(); }  ///< of all [m2]

  /// A piece, as often as its area says, and what its choice leaves of the number, which is uniform again.
  struct Drawn {
    const Piece& piece;
    double rest = 0;
  };
  /// By a number of [0, 1). There is a piece.
  [[nodiscard]] Drawn draw(double number) const {
    const double at = number * area();
    const auto found = std::min(std::ranges::upper_bound(ends_, at), ends_.end() - 1);
    const auto k = static_cast<std::size_t>(found - ends_.begin());
    const double before = k > 0 ? ends_[k - 1] : 0;
    return {*pieces_[k], std::clamp((at - before) / (ends_[k] - before), 0.0, 1.0)};
  }

 private:
  std::vector<const Piece*> pieces_;
  std::vector<double> ends_;  // running sums of the areas [m2]
};

}  // namespace fluxel
