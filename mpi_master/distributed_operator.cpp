#include "mpi_master/distributed_operator.hpp"

#include <algorithm>

namespace fluxel {

DistributedOperator::DistributedOperator(const Communicator& communicator, RowOperator& rows,
                                         std::size_t elements, bool two_sided)
    : communicator_(communicator), rows_(rows), elements_(elements), two_sided_(two_sided) {}

void DistributedOperator::apply(std::span<const Rgb> x, std::span<Rgb> H) {
  rows_.apply(x, H);
  gather(H);
}

void DistributedOperator::apply(std::span<const double> x, std::span<double> H) {
  rows_.apply(x, H);
  gather(H);
}

void DistributedOperator::sweep(std::span<const Rgb> E, std::span<const Rgb> rho, std::span<Rgb> x) {
  rows_.sweep(E, rho, x);
  gather(x);
}

void DistributedOperator::sweep(std::span<const double> E, std::span<const double> rho, std::span<double> x) {
  rows_.sweep(E, rho, x);
  gather(x);
}

template <class Value>
void DistributedOperator::gather(std::span<Value> values) {
  if (communicator_.size() == 1) return;
  const std::size_t first = rows_.first_row();
  const std::size_t rows = rows_.last_row() - first;
  for (std::size_t side = 0; side < (two_sided_ ? 2u : 1u); ++side) {
    // Ranks own ascending rows, so what is gathered in their order is the whole vector.
    const std::span<const Value> mine = values.subspan(side * elements_ + first, rows);
    const std::vector<Value> all = communicator_.all_gather(mine);
    std::ranges::copy(all, values.begin() + static_cast<std::ptrdiff_t>(side * elements_));
    gathered_bytes_ += (all.size() - rows) * sizeof(Value);
  }
}

}  // namespace fluxel
