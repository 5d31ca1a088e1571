#pragma once

#include <span>
#include <vector>

#include "formfactor/contour_filter.hpp"
#include "formfactor/corrections.hpp"
#include "formfactor/hidden_pairs.hpp"
#include "formfactor/near_pair.hpp"
#include "formfactor/share_filter.hpp"
#include "formfactor/tile_bounds.hpp"
#include "formfactor/visibility_probe.hpp"
#include "visibility/tile.hpp"

namespace fluxel {

/// True where the rules of the pairs leave something to correct at all.
[[nodiscard]] constexpr bool has_corrections(const FormFactorOptions& options) {
  return options.rule == FormFactor::adaptive || options.rule == FormFactor::points;
}

/// Finds the corrections of one tile after another, for options that have_corrections. With
/// FormFactor::adaptive these are the pairs whose moments_error exceeds kPairTolerance times the tolerance or
/// which cross each other's plane, and, with partial visibility, those at the edges of shadows (among bits
/// that differ, and wherever the share of the power is large) of which rays say other than the bit; with
/// FormFactor::points all pairs. Any number of threads may use it at once.
class TileExaminer {
 public:
  /// All must outlive this. Throws std::length_error for more unknowns than 32 bits count.
  TileExaminer(const RayScene& ray_scene, const Scene& scene, const ElementView& mesh,
               const FormFactorOptions& options, const PowerEstimate& power);

  /// False where tile (row, column) has no corrections whatever its bits: quickly told.
  [[nodiscard]] bool has_work(std::size_t row, std::size_t column) const;

  /// What examining tile (row, column >= row), which has work, takes on one thread, about [s]: a few of its
  /// pairs tell how many rays they are worth. Tiles differ by four orders of magnitude.
  [[nodiscard]] double predicted_seconds(std::size_t row, std::size_t column, TileTag tag) const;

  struct Found {
    std::vector<CorrectionEntry> entries;  ///< in both directions; each pair stands once in each
    CorrectionCounts counts;
  };

  [[nodiscard]] std::size_t elements() const { return elements_.size(); }
  [[nodiscard]] std::size_t unknowns() const { return power_.B.size(); }

  /// Adds what the rows [first, last) of tile (row, column >= row), whose bits these are, have to correct.
  void examine(std::size_t row, std::size_t column, const TileBits& bits, std::size_t first, std::size_t last,
               Found& found) const;

 private:
  /// Which pairs of a tile are looked at: those that may be near; all, where shares are so large that a pair
  /// deserves rays wherever it is; those at the edges of shadows, where shares are large enough for that.
  struct Work {
    bool near, large, small;
  };

  [[nodiscard]] Work work_of(std::size_t row, std::size_t column) const;
  /// Columns whose pair with element i may deserve rays: all of what is large, and edges of shadows.
  [[nodiscard]] std::uint64_t worth_rays(std::size_t i, std::size_t tile, const Work& work,
                                         std::uint64_t edges) const;
  [[nodiscard]] std::uint64_t near_candidates(std::size_t i, std::size_t tile) const;
  /// True where the kernel's rule errs more for the pair than it may.
  [[nodiscard]] bool needs_contour(std::size_t i, std::size_t j) const;
  /// What a pair takes, about, in rays.
  [[nodiscard]] double predicted_rays(const PairBit& pair, const Work& work, TileTag tag) const;
  /// True where the pair is one whose form factor the kernel cannot make.
  bool examine_near(const PairBit& pair, TileOccluders& occluders, Found& found) const;
  /// Of the power, seen from the centroids; 0 where no unknown sides face each other there.
  [[nodiscard]] double share_of(const PairBit& pair) const;
  /// Adds what the kernel's value lacks, in both directions.
  void add(const PairBit& pair, const SideExchanges& exchanges, std::vector<CorrectionEntry>& entries) const;

  const RayScene& ray_scene_;
  OcclusionScene occlusion_;
  ElementView mesh_;
  PairExaminer examiner_;
  std::span<const Element> elements_;
  const FormFactorOptions& options_;
  const PowerEstimate& power_;
  double pair_tolerance_;
  ContourFilter filter_;
  std::vector<TileShape> shapes_;
  std::vector<TilePower> powers_;
  ShareFilter shares_;
  BodyTree bodies_;
  std::vector<PatchId> patches_;  // that has all of a tile, or kNoPatch
  std::vector<HiddenPairs::TileCorners> corners_;
};

}  // namespace fluxel
