#include "mpi_master/steps/form_factor_matrix.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "core/options.hpp"
#include "mpi_master/communication/host_gather.hpp"
#include "mpi_master/steps/own_rows.hpp"
#include "solver/cuda/row_matrix.hpp"
#include "solver/estimate_power.hpp"
#include "solver/reductions.hpp"

namespace fluxel {

namespace {

/// Row sums of closed scenes are made what they should be where that moves the mean radiosity by more: a
/// tenth of the error that is asked for unless told.
constexpr double kWorthClosing = 1e-3;

/// Then so near, or in so many sweeps at most.
constexpr ClosureGoal kClosedEnough{1e-5, 30};

/// Collective: the rank's GPU with its rows of the matrix, or null.
std::unique_ptr<RowDevice> row_device_of(const Communicator& communicator, const FormFactorParts& parts,
                                         const FormFactorOptions& options, PairColumnsView columns,
                                         std::string& failure, FormFactorStatistics& statistics) {
  if (parts.device == Device::cpu) return nullptr;
  RankDevice own = find_rank_device(communicator.host());
  std::unique_ptr<RowDevice> device;
  if (own.found())
    own.why_not = device_failure_of([&] {
      auto rows = make_device_rows(row_matrix(parts.mesh.elements, columns, parts.visibility.store,
                                              kernel_rule(options), parts.two_sided),
                                   own.number, own.memory);
      device = std::make_unique<RowDevice>(
          std::move(rows), [&failure](const cuda::DeviceError& error) { failure = error.what(); });
    });
  statistics.without_gpu = device_failures_of_all(communicator, device ? std::string() : own.why_not);
  statistics.gpu_ranks = communicator.size() - static_cast<int>(statistics.without_gpu.size());
  return device;
}

/// Where the rows are made: the columns and the power of all, and this rank's GPU or null.
struct RowPlace {
  PairColumnsView columns;
  HostPower& power;
  RowDevice* device;
};

RowOperator rows_of(const FormFactorParts& parts, const FormFactorOptions& options,
                    const Corrections& corrections, const RowPlace& place, int threads) {
  RowOperator rows(parts.mesh.elements, place.columns, parts.visibility.store, corrections,
                   kernel_rule(options), parts.two_sided, threads);
  rows.use(place.power);
  if (place.device != nullptr) rows.use(*place.device);
  return rows;
}

/// What a pair is worth, of all unknowns, by what is known of the light; where nothing is, the matrix without
/// corrections tells it well enough.
PowerEstimate power_of(const Communicator& communicator, const FormFactorParts& parts, RowOperator rows) {
  const OwnRows rows_here(parts.visibility.store.owned(), parts.mesh.elements.size(), parts.two_sided);
  const PowerEstimate own = parts.light.known() ? power_of_light(rows.ranks(), rows_here.of(parts.light.B),
                                                                 rows_here.of(parts.light.H))
                                                : estimate_power(rows, parts.unknowns);
  const auto all = [&](std::span<const double> mine) {
    const SharedArray<double> of_host = gather_on_hosts(communicator, mine, parts.two_sided ? 2 : 1);
    return std::vector<double>(of_host.items().begin(), of_host.items().end());
  };
  return {all(own.B), all(own.H)};
}

Corrections corrections_of(const Workers& workers, const FormFactorParts& parts,
                           const FormFactorOptions& options, const RowPlace& place,
                           FormFactorStatistics& statistics) {
  const auto& [communicator, threads, progress] = workers;
  if (!has_corrections(options)) return {};
  progress.begin("power estimate");
  const Corrections none;
  const PowerEstimate power = power_of(communicator, parts, rows_of(parts, options, none, place, threads));
  progress.end();
  const TileExaminer examiner(parts.ray_scene, parts.scene, parts.mesh, options, power);
  FoundCorrections found =
      find_corrections(workers, examiner, parts.visibility.owners, parts.visibility.store);
  std::uint64_t bytes = found.corrections.bytes();
  communicator.all_sum(std::span(&bytes, 1));
  statistics.corrections = found.counts;
  statistics.correction_bytes = bytes;
  statistics.corrections_schedule = std::move(found.schedule);
  return std::move(found.corrections);
}

}  // namespace

FormFactorMatrix::FormFactorMatrix(const Workers& workers, const FormFactorParts& parts,
                                   const FormFactorOptions& options)
    : columns_(workers.communicator.host(), parts.mesh.elements),
      power_(workers.communicator, parts.visibility.store.owned(), parts.two_sided),
      device_(
          row_device_of(workers.communicator, parts, options, columns_.view(), device_failure_, statistics_)),
      corrections_(
          corrections_of(workers, parts, options, {columns_.view(), power_, device_.get()}, statistics_)),
      rows_(
          rows_of(parts, options, corrections_, {columns_.view(), power_, device_.get()}, workers.threads)) {
  workers.progress.begin("row sums");
  scale(parts, options);
  workers.progress.end();
}

void FormFactorMatrix::scale(const FormFactorParts& parts, const FormFactorOptions& options) {
  const Ranks& ranks = rows_.ranks();
  const std::vector<double> sums = row_sums_of(rows_, parts.unknowns.size());
  statistics_.row_sum_max = largest_over(ranks, sums.empty() ? 0.0 : *std::ranges::max_element(sums));
  statistics_.closure_defect_rms = closure_defect_rms(ranks, parts.unknowns.area, sums, parts.views);
  const std::vector<double> wanted = wanted_row_sums(ranks, sums, parts.views);
  const bool costly = options.rule == FormFactor::adaptive && parts.scene.statistics.closed &&
                      cost_of_defect(ranks, parts.unknowns, sums, wanted) > kWorthClosing;
  if (options.closure || costly) {
    statistics_.closure = find_closure(rows_, wanted, options.closure ? ClosureGoal{} : kClosedEnough);
    scaled_.emplace(rows_, statistics_.closure->scale);
  } else if (options.rule == FormFactor::adaptive && statistics_.row_sum_max > 1) {
    std::uint64_t capped =
        static_cast<std::uint64_t>(std::ranges::count_if(sums, [](double sum) { return sum > 1; }));
    ranks.sum(std::span(&capped, 1));
    statistics_.capped_rows = capped;
    scaled_.emplace(rows_, cap_row_sums(sums));
  }
}

RadiosityOperator& FormFactorMatrix::factors() {
  if (scaled_) return *scaled_;
  return rows_;
}

}  // namespace fluxel
