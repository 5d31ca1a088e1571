#include "mpi_master/steps/host_power.hpp"

#include <chrono>

#include "core/rgb.hpp"
#include "mpi_master/communication/communicator_ranks.hpp"

namespace fluxel {

HostPower::HostPower(const Communicator& communicator, const TileRows& owned, bool two_sided)
    : communicator_(communicator), ranks_(ranks_of(communicator_)), sides_(two_sided ? 2 : 1) {
  const std::vector<TileRows> of_ranks = communicator_.all_gather(std::span(&owned, 1));
  for (const ItemRange& ranks : communicator_.hosts()) {
    const std::size_t first = of_ranks[ranks.first].first;
    tiles_of_hosts_.push_back({first, of_ranks[ranks.first + ranks.count - 1].last - first});
  }
  const std::size_t tiles = of_ranks.back().last;
  lines_ = SharedArray<ColumnPower::Line>(communicator_.host(), 2 * tiles * sides_ * kChannels);
  sends_ = SharedArray<std::uint8_t>(communicator_.host(), tiles);
}

SentPower HostPower::room(std::size_t channels) {
  const std::size_t lines = sends_.size() * sides_ * channels;
  return {ColumnPower(lines_.items().first(lines), sides_, channels),
          ColumnPower(lines_.items().last(lines), sides_, channels), sends_.items()};
}

void HostPower::exchange(SentPower& sent) {
  if (communicator_.size() == 1) return;
  using Clock = std::chrono::steady_clock;
  const Clock::time_point begin = Clock::now();
  lines_.publish();
  if (communicator_.is_leader() && tiles_of_hosts_.size() > 1) gather(sent);
  lines_.publish();
  gathered_.wait_seconds += std::chrono::duration<double>(Clock::now() - begin).count();
}

void HostPower::gather(SentPower& sent) {
  const Communicator& leaders = communicator_.leaders();
  const std::size_t of_tile = sent.power.lines().size() / sent.sends.size();
  std::vector<ItemRange> lines_of_hosts;
  for (const ItemRange& tiles : tiles_of_hosts_)
    lines_of_hosts.push_back({tiles.first * of_tile, tiles.count * of_tile});
  for (const std::span<ColumnPower::Line> lines : {sent.power.lines(), sent.rest.lines()})
    leaders.start_gather(lines, std::span<const ItemRange>(lines_of_hosts));
  leaders.start_gather(sent.sends, std::span<const ItemRange>(tiles_of_hosts_));
  leaders.finish_gathers();
  const std::size_t received =
      sent.sends.size() - tiles_of_hosts_[static_cast<std::size_t>(leaders.rank())].count;
  gathered_.bytes += received * (2 * of_tile * sizeof(ColumnPower::Line) + sizeof(std::uint8_t));
  ++gathered_.gathers;
}

}  // namespace fluxel
