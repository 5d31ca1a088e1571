#include "output/view_factor_page.hpp"

#include <algorithm>
#include <functional>
#include <limits>
#include <vector>

#include "core/options.hpp"
#include "output/html/html_page.hpp"
#include "output/json_parts.hpp"
#include "output/run_page.hpp"

namespace fluxel {

namespace {

/// Sides in the map.
constexpr std::size_t kMostSides = 160;

/// Of the largest sides that see any: names, areas and sums, and the factors between them as [from, to, F].
Json matrix_json(const Scene& scene, const ExchangeTable& table) {
  const std::span<const double> areas = table.areas;
  const std::vector<double> sums = row_sums(table);
  std::vector<std::uint32_t> shown;
  for (std::uint32_t side = 0; side < areas.size(); ++side)
    if (sums[side] > 0) shown.push_back(side);
  const std::size_t all = shown.size();
  if (all > kMostSides) {
    std::ranges::stable_sort(shown, std::greater{}, [&](std::uint32_t side) { return areas[side]; });
    shown.resize(kMostSides);
    std::ranges::sort(shown);
  }
  constexpr std::uint32_t kNotShown = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> place(areas.size(), kNotShown);
  Json surfaces = Json::array(), entries = Json::array();
  for (const std::uint32_t side : shown) {
    place[side] = static_cast<std::uint32_t>(surfaces.size());
    surfaces.push_back({{"name", scene.groups[side / 2]},
                        {"back", side % 2 == 1},
                        {"area_m2", areas[side]},
                        {"row_sum", sums[side]}});
  }
  visit_rows(table, [&](std::span<const SurfaceViewFactor> row) {
    if (place[row[0].from] == kNotShown) return;
    for (const SurfaceViewFactor& factor : row)
      if (place[factor.to] != kNotShown)
        entries.push_back({place[factor.from], place[factor.to], static_cast<float>(factor.value)});
  });
  return {{"surfaces", surfaces}, {"factors", entries}, {"left_out", all - shown.size()}};
}

}  // namespace

void write_view_factor_page(const std::filesystem::path& file, const ViewFactorOptions& options,
                            const Scene& scene, const ExchangeTable& table, const ViewFactorChecks& checks,
                            int ranks) {
  HtmlPage page;
  page.kind = "viewfactors";
  page.name = scene.name;
  page.command = command_text(options.command, static_cast<std::size_t>(ranks));
  page.report = {
      {"row_sums",
       {{"least", checks.min_row_sum}, {"mean", checks.mean_row_sum}, {"largest", checks.max_row_sum}}},
      {"largest_error", checks.max_error},
      {"reciprocity", checks.reciprocity},
      {"notes", scene.notes}};
  if (!table.exchanges.empty()) page.matrix = matrix_json(scene, table);
  write_html_page(file, page);
}

}  // namespace fluxel
