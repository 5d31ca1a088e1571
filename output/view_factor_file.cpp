#include "output/view_factor_file.hpp"

#include <fmt/compile.h>
#include <fmt/format.h>

#include <string>
#include <vector>

#include "core/file.hpp"
#include "output/csv.hpp"

namespace fluxel {

void write_view_factors(const std::filesystem::path& file, const Scene& scene, const ExchangeTable& table) {
  std::vector<std::string> names;
  for (const std::string& group : scene.groups)
    for (const char* side : {"front", "back"}) names.push_back(csv_field(group) + "," + side);
  write_parts_atomically(file, [&](const auto& append) {
    append("from,from_side,to,to_side,area_from_m2,view_factor,error_estimate\n");
    fmt::memory_buffer text;
    visit_rows(table, [&](std::span<const SurfaceViewFactor> row) {
      text.clear();
      const std::string from = names[row[0].from], area = fmt::format("{:.12g}", table.areas[row[0].from]);
      for (const SurfaceViewFactor& f : row)
        fmt::format_to(fmt::appender(text), FMT_COMPILE("{},{},{},{:.12g},{:.2g}\n"), from, names[f.to], area,
                       f.value, f.error);
      append({text.data(), text.size()});
    });
  });
}

}  // namespace fluxel
