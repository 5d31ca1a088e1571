#include "output/group_factor_files.hpp"

#include <algorithm>
#include <system_error>

#include "output/view_factor_file.hpp"
#include "output/view_factor_matrix.hpp"

namespace fluxel {

static_assert(kGroupFactorFiles[0] == std::string_view(kViewFactorFile) &&
              kGroupFactorFiles[1] == std::string_view(kViewFactorMatrix) &&
              kGroupFactorFiles[2] == std::string_view(kSurfaceFile));

std::vector<std::string> write_group_factors(const std::filesystem::path& folder, const Scene& scene,
                                             const ExchangeTable& groups,
                                             std::span<const std::string> asked) {
  const bool table_asked = std::ranges::find(asked, kTableAsked) != asked.end();
  const bool matrix_asked = std::ranges::find(asked, kMatrixAsked) != asked.end();
  const bool many = scene.groups.size() > kMostGroupsInTable;
  std::vector<std::string> written;
  if (table_asked || (!matrix_asked && !many)) {
    write_view_factors(folder / kViewFactorFile, scene, groups);
    written.emplace_back(kViewFactorFile);
  }
  if (matrix_asked || (!table_asked && many)) {
    write_view_factor_matrix(folder / kViewFactorMatrix, groups);
    write_surfaces(folder / kSurfaceFile, scene, groups.areas);
    written.emplace_back(kViewFactorMatrix);
    written.emplace_back(kSurfaceFile);
  }
  for (const char* file : kGroupFactorFiles) {
    std::error_code ignored;  // what cannot be removed is not in the way
    if (std::ranges::find(written, file) == written.end()) std::filesystem::remove(folder / file, ignored);
  }
  return written;
}

}  // namespace fluxel
