#pragma once

#include "bench/simulate/engine.hpp"
#include "bench/simulate/traced_scene.hpp"
#include "mpi_master/scheduling/row_owners.hpp"
#include "mpi_master/scheduling/strip_scheduler.hpp"

namespace fluxel::bench {

/// Bytes and tiles for every rank, gathered over the parts of a batch.
class DeliveryBook {
 public:
  explicit DeliveryBook(int ranks) : place_(static_cast<std::size_t>(ranks), kNone) {}

  void add(int target, double tiles, double bytes);
  /// What has been gathered; begins anew.
  [[nodiscard]] std::vector<Delivery> take();

 private:
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  std::vector<std::size_t> place_;  // by rank, in deliveries_
  std::vector<Delivery> deliveries_;
};

/// The visibility phase as it is: the scheduler's and the owners' own code, scheduling strips by the
/// forecast's costs; what tiles really take is the map's.
class StripWork final : public SimulatedWork {
 public:
  /// The scene must outlive this.
  StripWork(const TracedScene& scene, const RowOwners& owners);

  [[nodiscard]] std::optional<TileRange> next(int rank) override { return scheduler_.next(rank); }
  [[nodiscard]] Batch compute(const TileRange& tiles) override;

 private:
  const TracedScene& scene_;
  TileTriangle triangle_;
  RowOwners owners_;
  StripScheduler scheduler_;
  DeliveryBook book_;
};

}  // namespace fluxel::bench
