#include "bench/gpu_check/rows.hpp"

#include <cstdio>
#include <memory>

#include "bench/gpu_check/json.hpp"
#include "solver/cuda/device_rows.hpp"

namespace fluxel::cuda::checks {

namespace {

/// Of the largest sum: a few units in the last place of single precision.
constexpr double kMaxDifference = 1e-6;

const char* name_of(Rule rule) {
  return rule == Rule::point ? "point" : rule == Rule::disc ? "disc" : "moments";
}

}  // namespace

bool RowFigures::right() const { return found.largest_difference <= kMaxDifference && found.repeats; }

std::vector<RowFigures> check_rows_on_device(const std::vector<std::size_t>& elements, int device,
                                             std::size_t memory) {
  std::vector<RowCheckCase> cases;
  const auto least = static_cast<std::uint32_t>(elements.front());
  for (const Rule rule : {Rule::point, Rule::disc, Rule::moments})
    for (const bool two_sided : {false, true})
      for (const std::uint32_t channels : {1u, 3u}) cases.push_back({least, rule, two_sided, channels});
  for (std::size_t k = 1; k < elements.size(); ++k)
    cases.push_back({static_cast<std::uint32_t>(elements[k]), Rule::moments, false, 3});
  std::vector<RowFigures> rows;
  rows.reserve(cases.size());
  for (const RowCheckCase& of : cases)
    rows.push_back({of, check_rows(of, [&](const RowMatrix& matrix) {
                      return std::make_unique<DeviceRows>(matrix, device, memory);
                    })});
  return rows;
}

void print_rows(const std::vector<RowFigures>& rows) {
  std::printf("\nproducts of the solve's matrix on the device, of random bits\n");
  std::printf("%9s %8s %6s %9s %15s %12s %14s %13s\n", "elements", "rule", "sides", "channels",
              "Gpairs/s of N^2", "kernel [ms]", "transfer [ms]", "difference");
  for (const RowFigures& row : rows)
    std::printf("%9u %8s %6d %9u %15.3g %12.3g %14.3g %13.2g%s\n", row.of.elements, name_of(row.of.rule),
                row.of.two_sided ? 2 : 1, row.of.channels,
                1e-9 * row.found.pairs / (row.found.kernel_seconds + row.found.transfer_seconds),
                1e3 * row.found.kernel_seconds, 1e3 * row.found.transfer_seconds,
                row.found.largest_difference, row.right() ? "" : "  WRONG");
}

std::string to_json(const std::vector<RowFigures>& rows) {
  std::vector<std::string> all;
  all.reserve(rows.size());
  for (const RowFigures& row : rows)
    all.push_back(json::object({{"elements", json::number(row.of.elements)},
                                {"rule", json::text(name_of(row.of.rule))},
                                {"sides", json::number(row.of.two_sided ? 2 : 1)},
                                {"channels", json::number(row.of.channels)},
                                {"pairs", json::number(row.found.pairs)},
                                {"gathered_pairs", json::number(row.found.gathered_pairs)},
                                {"upload_seconds", json::number(row.found.upload_seconds)},
                                {"kernel_seconds", json::number(row.found.kernel_seconds)},
                                {"transfer_seconds", json::number(row.found.transfer_seconds)},
                                {"compared_tile_rows", json::number(row.found.compared_tile_rows)},
                                {"largest_difference", json::number(row.found.largest_difference)},
                                {"repeats", row.found.repeats ? "true" : "false"}}));
  return json::list(all);
}

}  // namespace fluxel::cuda::checks
