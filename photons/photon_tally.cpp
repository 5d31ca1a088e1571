#include "photons/photon_tally.hpp"

#include <algorithm>
#include <utility>

namespace fluxel {

PhotonTally::PhotonTally(const TallyShape& shape)
    : shape_(shape),
      parts_(place(PhotonFate::count)),
      received_(parts_ + shape.parts),
      slots_(received_ + 1 + shape.cells.size()),
      squares_(slots_ + shape.slots() * shape.parts * kChannels),
      values_(size_of(shape), 0) {}

void PhotonTally::take_over(const PhotonTally& other, std::span<const std::size_t> slots) {
  std::copy_n(other.values_.begin(), slots_, values_.begin());
  for (std::size_t slot = 0; slot < slots.size(); ++slot) {
    if (slots[slot] >= shape_.slots()) continue;
    for (std::size_t part = 0; part < shape_.parts; ++part)
      std::copy_n(other.values_.begin() + static_cast<std::ptrdiff_t>(other.place(slot, part)), kChannels,
                  values_.begin() + static_cast<std::ptrdiff_t>(place(slots[slot], part)));
  }
}

void PhotonTally::take(PhotonTally& other) {
  for (std::size_t k = 0; k < values_.size(); ++k) values_[k] += std::exchange(other.values_[k], 0);
}

std::size_t PhotonTally::size_of(const TallyShape& shape) {
  const std::size_t cells = shape.slots() - shape.sides;
  return place(PhotonFate::count) + shape.parts + 1 + shape.cells.size() +
         shape.slots() * shape.parts * kChannels + (shape.has_squares ? cells * kChannels : 0);
}

bool PhotonTally::has_room_for(std::uint64_t photons) const {
  constexpr double kMost = 0x1p62;
  const auto largest = static_cast<double>(*std::ranges::max_element(values_));
  const auto sent = static_cast<double>(std::max<std::uint64_t>(count(PhotonCount::sent), 1));
  return largest + 2 * largest / sent * static_cast<double>(photons) < kMost;
}

}  // namespace fluxel
