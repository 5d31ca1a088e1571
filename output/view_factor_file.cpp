#include "output/view_factor_file.hpp"

#include <fmt/format.h>

#include <iterator>
#include <string>
#include <vector>

#include "core/file.hpp"
#include "output/csv.hpp"

namespace fluxel {

void write_view_factors(const std::filesystem::path& file, const Scene& scene,
                        std::span<const SurfaceViewFactor> factors, std::span<const double> areas) {
  std::vector<std::string> names;
  for (const std::string& group : scene.groups)
    for (const char* side : {"front", "back"}) names.push_back(csv_field(group) + "," + side);
  fmt::memory_buffer text;
  fmt::format_to(std::back_inserter(text),
                 "from,from_side,to,to_side,area_from_m2,view_factor,error_estimate\n");
  for (const SurfaceViewFactor& f : factors)
    fmt::format_to(std::back_inserter(text), "{},{},{:.12g},{:.12g},{:.2g}\n", names[f.from], names[f.to],
                   areas[f.from], f.value, f.error);
  write_bytes_atomically(file, fmt::to_string(text));
}

}  // namespace fluxel
