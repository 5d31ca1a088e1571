#include "mpi_master/steps/form_factor_matrix.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "solver/cuda/row_matrix.hpp"
#include "solver/estimate_power.hpp"

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

/// What a pair is worth, which the matrix without corrections tells well enough; on all ranks.
PowerEstimate power_of(const Communicator& communicator, const FormFactorParts& parts,
                       const FormFactorOptions& options, int threads, PairColumnsView columns,
                       RowDevice* device) {
  const std::size_t elements = parts.mesh.elements.size();
  const Corrections none;
  RowOperator rows(parts.mesh.elements, columns, parts.visibility.store, none, kernel_rule(options),
                   parts.two_sided, threads);
  if (device != nullptr) rows.use(*device);
  DistributedOperator all_rows(communicator, rows, elements, parts.two_sided, threads);
  const std::size_t unknowns = (parts.two_sided ? 2 : 1) * elements;
  SharedArray<double> of_host(communicator.host(), 2 * unknowns);
  const std::span<double> B = of_host.items().first(unknowns), H = of_host.items().last(unknowns);
  all_rows.lead([&] {
    const PowerEstimate found = estimate_power(all_rows, parts.unknowns);
    std::ranges::copy(found.B, B.begin());
    std::ranges::copy(found.H, H.begin());
  });
  of_host.publish();
  return {{B.begin(), B.end()}, {H.begin(), H.end()}};
}

Corrections corrections_of(const Workers& workers, const FormFactorParts& parts,
                           const FormFactorOptions& options, PairColumnsView columns, RowDevice* device,
                           FormFactorStatistics& statistics) {
  const auto& [communicator, threads, progress] = workers;
  if (!has_corrections(options)) return {};
  progress.begin("power estimate");
  const PowerEstimate power = power_of(communicator, parts, options, threads, columns, device);
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
      device_(
          row_device_of(workers.communicator, parts, options, columns_.view(), device_failure_, statistics_)),
      corrections_(corrections_of(workers, parts, options, columns_.view(), device_.get(), statistics_)),
      rows_(parts.mesh.elements, columns_.view(), parts.visibility.store, corrections_, kernel_rule(options),
            parts.two_sided, workers.threads),
      all_rows_(workers.communicator, rows_, parts.mesh.elements.size(), parts.two_sided, workers.threads) {
  if (device_) rows_.use(*device_);
  workers.progress.begin("row sums");
  all_rows_.lead([&] { scale(parts, options); });
  workers.progress.end();
}

void FormFactorMatrix::scale(const FormFactorParts& parts, const FormFactorOptions& options) {
  const std::vector<double> sums = row_sums_of(all_rows_, parts.unknowns.size());
  statistics_.row_sum_max = sums.empty() ? 0 : *std::ranges::max_element(sums);
  statistics_.closure_defect_rms = closure_defect_rms(parts.unknowns.area, sums, parts.views);
  const std::vector<double> wanted = wanted_row_sums(sums, parts.views);
  const bool costly = options.rule == FormFactor::adaptive && parts.scene.statistics.closed &&
                      cost_of_defect(parts.unknowns, sums, wanted) > kWorthClosing;
  if (options.closure || costly) {
    statistics_.closure = find_closure(all_rows_, wanted, options.closure ? ClosureGoal{} : kClosedEnough);
    scaled_.emplace(all_rows_, statistics_.closure->scale);
  } else if (options.rule == FormFactor::adaptive && statistics_.row_sum_max > 1) {
    statistics_.capped_rows =
        static_cast<std::size_t>(std::ranges::count_if(sums, [](double sum) { return sum > 1; }));
    scaled_.emplace(all_rows_, cap_row_sums(sums));
  }
}

RadiosityOperator& FormFactorMatrix::factors() {
  if (scaled_) return *scaled_;
  return all_rows_;
}

}  // namespace fluxel
