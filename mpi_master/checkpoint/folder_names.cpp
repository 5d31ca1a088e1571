#include "mpi_master/checkpoint/folder_names.hpp"

#include <algorithm>

namespace fluxel {

std::vector<std::string> names_in(const std::filesystem::path& folder, std::error_code& failed) {
  std::vector<std::string> names;
  for (std::filesystem::directory_iterator at(folder, failed), end; !failed && at != end;
       at.increment(failed))
    names.push_back(at->path().filename().string());
  std::ranges::sort(names);
  return names;
}

}  // namespace fluxel
