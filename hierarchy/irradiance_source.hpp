#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "core/progress.hpp"
#include "hierarchy/gather.hpp"
#include "hierarchy/node_tree.hpp"

namespace fluxel {

/// A finished solution, asked for the irradiance of points. Gathers are collective, with the same answer on
/// all ranks and for every number of them.
class IrradianceSource {
 public:
  IrradianceSource() = default;
  virtual ~IrradianceSource() = default;
  IrradianceSource(const IrradianceSource&) = delete;
  IrradianceSource& operator=(const IrradianceSource&) = delete;

  /// The irradiance of points, of any nodes of the tree that are faces; 0 where a point has none.
  [[nodiscard]] virtual std::vector<Rgb> gather(std::span<const GatherPoint> points, const GatherGoal& goal,
                                                Progress& progress) = 0;
  /// Likewise by two halves, each by rays of its own, whose mean is what the goal asks for.
  [[nodiscard]] virtual std::array<std::vector<Rgb>, 2> gather_halves(std::span<const GatherPoint> points,
                                                                      const GatherGoal& goal,
                                                                      Progress& progress) = 0;

  /// Whether all light comes by rays over the hemisphere, more or less noisy everywhere; else by links, which
  /// are noisy in shadows alone.
  [[nodiscard]] virtual bool by_rays() const = 0;
  [[nodiscard]] virtual const NodeTree& tree() const = 0;
  [[nodiscard]] virtual std::uint64_t gather_rays() const = 0;  ///< of this rank, so far
  [[nodiscard]] virtual Rgb mean_radiosity() const = 0;         ///< of all surfaces, by rays about [W/m2]

  /// What all ranks are to call together between parts of long calls. When this rank has been asked to stop
  /// (see core/signals), the part is left unfinished, so that what is called has to throw.
  void handle_signals_by(std::function<void()> signals) { signal_handler_ = std::move(signals); }

 protected:
  [[nodiscard]] bool is_stopped() const;
  void handle_signals() const;

 private:
  std::function<void()> signal_handler_;
};

}  // namespace fluxel
