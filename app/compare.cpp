#include "app/compare.hpp"

#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <vector>

#include "core/file.hpp"
#include "core/options.hpp"
#include "mpi_master/communication/agreement.hpp"
#include "output/comparands.hpp"
#include "output/comparison_report.hpp"

namespace fluxel {

namespace {

constexpr std::uint64_t kAbove = 3;

std::uint64_t compare_files(const CompareOptions& options) {
  // 1. Both files.
  if (!options.out.empty()) {
    const std::array<std::filesystem::path, 2> inputs{options.judged, options.reference};
    std::vector<std::filesystem::path> outputs;
    outputs.reserve(kComparisonFiles.size());
    for (const char* name : kComparisonFiles) outputs.push_back(std::filesystem::path(options.out) / name);
    require_inputs_kept(inputs, outputs);
    require_writable_folder(options.out);
  }
  const Comparands of = read_comparands(options.judged, options.reference);

  // 2. The errors.
  const ComparisonReport report = compare(of);

  // 3. The table and the files.
  if (!options.out.empty()) write_comparison(options, of, report);
  if (!options.quiet) fmt::print("{}", comparison_table(options, of, report));
  return options.fail_above && report.errors.bound() > *options.fail_above ? kAbove : 0;
}

}  // namespace

int run_compare(const Communicator& world, const CompareOptions& options) {
  std::uint64_t code = 0;
  on_root(world, [&] { code = compare_files(options); });
  world.all_sum(std::span(&code, 1));  // the others have 0
  return static_cast<int>(code);
}

}  // namespace fluxel
