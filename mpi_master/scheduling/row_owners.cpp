#include "mpi_master/scheduling/row_owners.hpp"

#include <numeric>

namespace fluxel {

RowOwners::RowOwners(std::span<const double> row_costs, int ranks) {
  std::vector<double> before(row_costs.size() + 1);
  std::partial_sum(row_costs.begin(), row_costs.end(), before.begin() + 1);
  first_.push_back(0);
  for (int rank = 1; rank < ranks; ++rank) {
    const double wanted = before.back() * rank / ranks;
    // The cut that is nearer to what is wanted.
    auto cut = static_cast<std::size_t>(std::ranges::lower_bound(before, wanted) - before.begin());
    if (cut > 0 && wanted - before[cut - 1] < before[cut] - wanted) --cut;
    first_.push_back(std::clamp(cut, first_.back(), row_costs.size()));
  }
  first_.push_back(row_costs.size());
}

}  // namespace fluxel
