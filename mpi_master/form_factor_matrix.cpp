#include "mpi_master/form_factor_matrix.hpp"

#include <algorithm>
#include <utility>

#include "solver/estimate_power.hpp"

namespace fluxel {

namespace {

Corrections corrections_of(const Communicator& communicator, const FormFactorParts& parts,
                           const FormFactorOptions& options, int threads, Progress& progress,
                           FormFactorFacts& facts) {
  if (!has_corrections(options)) return {};
  const std::vector<Element>& elements = parts.mesh.elements;
  const bool two_sided = parts.unknowns.two_sided;
  // What a pair is worth is told well enough by the matrix without corrections.
  const Corrections none;
  RowOperator rows(elements, parts.visibility.store, none, kernel_rule(options), two_sided, threads);
  DistributedOperator all_rows(communicator, rows, elements.size(), two_sided, threads);
  const PowerEstimate power = estimate_power(all_rows, parts.unknowns);
  const TileExaminer examiner(parts.ray_scene, parts.scene, parts.mesh, options, power);
  FoundCorrections found = find_corrections(communicator, examiner, parts.visibility.owners,
                                            parts.visibility.store, threads, progress);
  std::uint64_t bytes = found.corrections.bytes();
  communicator.all_sum(std::span(&bytes, 1));
  facts.corrections = found.counts;
  facts.correction_bytes = bytes;
  facts.corrections_dealt = std::move(found.dealt);
  return std::move(found.corrections);
}

}  // namespace

FormFactorMatrix::FormFactorMatrix(const Communicator& communicator, const FormFactorParts& parts,
                                   const FormFactorOptions& options, int threads, Progress& progress)
    : corrections_(corrections_of(communicator, parts, options, threads, progress, facts_)),
      rows_(parts.mesh.elements, parts.visibility.store, corrections_, kernel_rule(options),
            parts.unknowns.two_sided, threads),
      all_rows_(communicator, rows_, parts.mesh.elements.size(), parts.unknowns.two_sided, threads) {
  const std::vector<double> sums = row_sums_of(all_rows_, parts.unknowns.size());
  facts_.row_sum_max = sums.empty() ? 0 : *std::ranges::max_element(sums);
  facts_.closure_defect_rms = closure_defect_rms(parts.unknowns.area, sums, parts.views);
  if (options.closure) {
    facts_.closure = find_closure(all_rows_, wanted_row_sums(sums, parts.views));
    scaled_.emplace(all_rows_, facts_.closure->scale);
  } else if (options.rule == FormFactor::adaptive && facts_.row_sum_max > 1) {
    facts_.capped_rows =
        static_cast<std::size_t>(std::ranges::count_if(sums, [](double sum) { return sum > 1; }));
    scaled_.emplace(all_rows_, cap_row_sums(sums));
  }
}

RadiosityOperator& FormFactorMatrix::factors() {
  if (scaled_) return *scaled_;
  return all_rows_;
}

}  // namespace fluxel
