#include "solver/cuda/device_rows.hpp"

#include <algorithm>
#include <vector>

#include "solver/cuda/gather_slice.hpp"
#include "visibility/cuda/device_memory.cuh"

namespace fluxel::cuda {

namespace {

/// Warps of a multiprocessor that run at once: more would have too few registers.
constexpr unsigned kWarpsAtOnce = 16;

/// A block of threads is a warp, which makes a slice of a tile row; slices of a row follow one another.
template <class Kind>
__global__ void __launch_bounds__(kLanes, kWarpsAtOnce)
    gather_slices(RowView view, std::uint32_t first_row, std::uint32_t slices, double* of_slices) {
  __shared__ SliceMemory<Kind> memory;
  gather_slice<Kind>(Warp(), view, first_row + blockIdx.x / slices, blockIdx.x % slices, memory,
                     of_slices + std::size_t{blockIdx.x} * Kind::kLines * kTile);
}

constexpr unsigned kAddingThreads = 256;

/// A thread adds one of the `items` sums of a tile row.
__global__ void add_all_slices(const double* of_slices, std::uint32_t slices, std::size_t items,
                               std::size_t count, double* sums) {
  const std::size_t k = std::size_t{blockIdx.x} * blockDim.x + threadIdx.x;
  if (k < count) sums[k] = add_slices(of_slices + k / items * slices * items + k % items, slices, items);
}

}  // namespace

struct DeviceRows::State {
  int device;
  RowShape shape;
  std::size_t most_items;  // numbers a tile
  Stream stream;
  Event begun, computed, sent;
  DeviceArray<float> columns;
  DeviceArray<TileEntry> entries;
  DeviceArray<std::uint64_t> bits;
  DeviceArray<float> power;
  DeviceArray<std::uint8_t> sends;
  DeviceArray<double> of_slices, sums;
  PinnedArray<double> host_sums;
  std::uint32_t channels = 1;
  DeviceSeconds seconds;

  State(const RowMatrix& matrix, int number)
      : device(number),
        shape(matrix.shape()),
        most_items(std::size_t{most_lines(shape)} * kTile),
        columns(matrix.column_numbers()),
        entries(matrix.entries().size()),
        bits(matrix.tiles_with_bits() * kTile),
        power(shape.tiles * most_items),
        sends(shape.tiles),
        of_slices(std::size_t{rows_at_once(shape)} * slices_of(shape.tiles) * most_items),
        sums(matrix.rows() * most_items),
        host_sums(matrix.rows() * most_items) {
    begun.record(stream);
    send(columns.data(), matrix.columns(), matrix.column_numbers());
    send(entries.data(), matrix.entries().data(), matrix.entries().size());
    send_bits(matrix);
    sent.record(stream);
    check(cudaStreamSynchronize(stream.get()), "take the rows");
    seconds.transfer += Event::seconds(begun, sent);
  }

  template <class Item>
  void send(Item* to, const Item* from, std::size_t count) {
    if (count == 0) return;
    check(cudaMemcpyAsync(to, from, count * sizeof(Item), cudaMemcpyHostToDevice, stream.get()),
          "take the rows");
  }

  /// Through two buffers in turn: one is sent while the next row is decoded into the other.
  void send_bits(const RowMatrix& matrix) {
    struct Buffer {
      PinnedArray<std::uint64_t> words;
      Event sent;
    };
    const std::size_t most = std::size_t{shape.tiles} * kTile;
    Buffer buffers[2] = {{PinnedArray<std::uint64_t>(most), {}}, {PinnedArray<std::uint64_t>(most), {}}};
    for (std::uint32_t row = shape.first_row; row < shape.last_row; ++row) {
      Buffer& buffer = buffers[row % 2];
      buffer.sent.wait();
      const std::size_t count = matrix.read_row(row, buffer.words.data());
      send(bits.data() + matrix.first_bits(row) * kTile, buffer.words.data(), count * kTile);
      buffer.sent.record(stream);
    }
    check(cudaStreamSynchronize(stream.get()), "take the bits");
  }

  [[nodiscard]] RowView view() const {
    return {columns.data(), power.data(), sends.data(),   entries.data(),
            bits.data(),    shape.tiles,  shape.first_row};
  }

  template <class Kind>
  void launch(std::uint32_t first, std::uint32_t last) {
    const std::uint32_t slices = slices_of(shape.tiles), step = rows_at_once(shape);
    constexpr std::size_t kItems = std::size_t{Kind::kLines} * kTile;
    for (std::uint32_t row = first; row < last; row += step) {
      const std::uint32_t rows = std::min(step, last - row);
      gather_slices<Kind><<<rows * slices, kLanes, 0, stream.get()>>>(view(), row, slices, of_slices.data());
      check(cudaGetLastError(), "start on rows");
      const std::size_t count = rows * kItems;
      add_all_slices<<<static_cast<unsigned>((count + kAddingThreads - 1) / kAddingThreads), kAddingThreads,
                       0, stream.get()>>>(of_slices.data(), slices, kItems, count,
                                          sums.data() + (row - first) * kItems);
      check(cudaGetLastError(), "add up rows");
    }
    computed.record(stream);
    check(cudaMemcpyAsync(host_sums.data(), sums.data(), (last - first) * kItems * sizeof(double),
                          cudaMemcpyDeviceToHost, stream.get()),
          "send rows");
  }
};

DeviceRows::DeviceRows(const RowMatrix& matrix, int device, std::size_t memory) {
  require_room(matrix, memory);
  check(cudaSetDevice(device), "be chosen");
  state_ = std::make_unique<State>(matrix, device);
}
DeviceRows::~DeviceRows() = default;

void DeviceRows::start(const float* power, const std::uint8_t* sends, std::uint32_t channels) {
  State& state = *state_;
  check(cudaSetDevice(state.device), "be chosen");
  state.channels = channels;
  state.begun.record(state.stream);
  state.send(state.power.data(), power,
             std::size_t{state.shape.tiles} * (state.shape.two_sided ? 2 : 1) * channels * kTile);
  state.send(state.sends.data(), sends, state.shape.tiles);
  state.sent.record(state.stream);
  check(cudaStreamSynchronize(state.stream.get()), "take the light");
  state.seconds.transfer += Event::seconds(state.begun, state.sent);
}

const double* DeviceRows::gather(std::uint32_t first, std::uint32_t last) {
  State& state = *state_;
  if (first == last) return state.host_sums.data();
  check(cudaSetDevice(state.device), "be chosen");
  state.begun.record(state.stream);
  with_kind(state.shape.rule, state.shape.two_sided, state.channels,
            [&](auto kind) { state.launch<decltype(kind)>(first, last); });
  state.sent.record(state.stream);
  check(cudaStreamSynchronize(state.stream.get()), "gather rows");
  state.seconds.kernel += Event::seconds(state.begun, state.computed);
  state.seconds.transfer += Event::seconds(state.computed, state.sent);
  return state.host_sums.data();
}

DeviceSeconds DeviceRows::seconds() const { return state_->seconds; }

}  // namespace fluxel::cuda
