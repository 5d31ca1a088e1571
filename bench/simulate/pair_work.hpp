#pragma once

#include "bench/simulate/strip_work.hpp"

namespace fluxel::bench {

/// The other task of Debelov & Sattarov (section 5): all pairs of elements of two patches, assigned one after
/// another. Where a patch is large, a task still is computed in batches, and numbered in units of a tile's
/// pairs. Costs and bytes of a pair are those of the tile that it lies in, so that small tasks cost no more
/// than their share: in favour of this task, since packets and codes of few pairs are worse.
class PairWork final : public SimulatedWork {
 public:
  /// The scene must outlive this.
  PairWork(const TracedScene& scene, const RowOwners& owners);

  [[nodiscard]] std::optional<TileRange> next(int rank) override;
  [[nodiscard]] Batch compute(const TileRange& units) override;

  [[nodiscard]] std::size_t tasks() const { return first_unit_.size() - 1; }

 private:
  struct Elements {
    std::size_t first, last;
  };
  [[nodiscard]] Elements patch(std::size_t index) const {
    return {scene_.first_element[index], scene_.first_element[index + 1]};
  }
  void hand_over(const Elements& to, double bytes);

  const TracedScene& scene_;
  RowOwners owners_;
  std::vector<std::uint32_t> row_patch_, column_patch_;  // by task
  std::vector<std::uint64_t> first_unit_;                // by task, and the end
  std::size_t next_task_ = 0;
  DeliveryBook book_;
};

}  // namespace fluxel::bench
