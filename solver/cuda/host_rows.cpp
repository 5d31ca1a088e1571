#include "solver/cuda/host_rows.hpp"

#include <chrono>

#include "solver/cuda/gather_slice.hpp"

namespace fluxel::cuda {

HostRows::HostRows(const RowMatrix& matrix)
    : shape_(matrix.shape()),
      entries_(matrix.entries()),
      bits_(matrix.tiles_with_bits() * kTile),
      view_{matrix.columns(), nullptr,      nullptr,         entries_.data(),
            bits_.data(),     shape_.tiles, shape_.first_row} {
  for (std::uint32_t row = shape_.first_row; row < shape_.last_row; ++row)
    matrix.read_row(row, bits_.data() + matrix.first_bits(row) * kTile);
}

void HostRows::start(const float* power, const std::uint8_t* sends, std::uint32_t channels) {
  channels_ = channels;
  power_.assign(power, power + std::size_t{shape_.tiles} * (shape_.two_sided ? 2 : 1) * channels * kTile);
  sends_.assign(sends, sends + shape_.tiles);
  view_.power = power_.data();
  view_.sends = sends_.data();
}

const double* HostRows::gather(std::uint32_t first, std::uint32_t last) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point begin = Clock::now();
  with_kind(shape_.rule, shape_.two_sided, channels_, [&](auto kind) {
    using OfRows = decltype(kind);
    constexpr std::size_t kItems = OfRows::kLines * kTile;
    const std::uint32_t slices = slices_of(shape_.tiles);
    std::vector<double> of_slices(slices * kItems);
    SliceMemory<OfRows> memory;
    sums_.resize((last - first) * kItems);
    for (std::uint32_t row = first; row < last; ++row) {
      for (std::uint32_t slice = 0; slice < slices; ++slice)
        gather_slice<OfRows>(Warp(), view_, row, slice, memory, of_slices.data() + slice * kItems);
      for (std::size_t item = 0; item < kItems; ++item)
        sums_[(row - first) * kItems + item] = add_slices(of_slices.data() + item, slices, kItems);
    }
  });
  seconds_.kernel += std::chrono::duration<double>(Clock::now() - begin).count();
  return sums_.data();
}

}  // namespace fluxel::cuda
