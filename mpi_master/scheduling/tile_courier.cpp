#include "mpi_master/scheduling/tile_courier.hpp"

#include <cstring>
#include <span>
#include <utility>

#include "mpi_master/scheduling/back_off.hpp"

namespace fluxel {

namespace {

constexpr int kCarriedTiles = 1;
constexpr std::size_t kMaxUnsent = std::size_t{4} << 20;  // [bytes], for all ranks together

}  // namespace

TileCourier::TileCourier(const Communicator& communicator, TileStore& store)
    : communicator_(communicator),
      store_(store),
      triangle_(store.tiles()),
      unsent_(static_cast<std::size_t>(communicator.size())) {}

void TileCourier::hand_over(int target, std::size_t row, std::size_t column, const TileView& tile) {
  const std::uint64_t number = triangle_.number(row, column);
  if (target == communicator_.rank()) return put(number, tile);
  Bytes& message = unsent_[static_cast<std::size_t>(target)];
  const std::size_t before = message.size();
  const auto bytes = std::as_bytes(std::span(&number, 1));
  message.insert(message.end(), bytes.begin(), bytes.end());
  append_tile(message, tile);
  unsent_bytes_ += message.size() - before;
  if (unsent_bytes_ > kMaxUnsent) send_all();
}

void TileCourier::finish() {
  send_all();
  communicator_.receive_all([this](const Message& message) { take(message); });
}

void TileCourier::send_all() {
  for (int target = 0; target < communicator_.size(); ++target) {
    Bytes& message = unsent_[static_cast<std::size_t>(target)];
    if (!message.empty()) communicator_.send(target, kCarriedTiles, std::exchange(message, {}));
  }
  unsent_bytes_ = 0;
  // What leaves slower than it is handed over would fill the memory.
  BackOff pause;
  while (communicator_.pending_sends() > kMaxPendingSends)
    if (const auto message = communicator_.receive()) {
      take(*message);
    } else {
      pause.wait();
    }
}

void TileCourier::take(const Message& message) {
  std::span<const std::byte> rest(message.data);
  while (!rest.empty()) {
    std::uint64_t number = 0;
    std::memcpy(&number, rest.data(), sizeof number);
    rest = rest.subspan(sizeof number);
    put(number, take_tile(rest));
  }
}

void TileCourier::put(std::uint64_t number, const TileView& tile) {
  const std::size_t row = triangle_.row_of(number), column = triangle_.column_of(row, number);
  if (!store_.has(row, column)) store_.put(row, column, tile.tag, tile.code);
}

}  // namespace fluxel
