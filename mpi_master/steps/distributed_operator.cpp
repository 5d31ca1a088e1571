#include "mpi_master/steps/distributed_operator.hpp"

#include <algorithm>
#include <chrono>
#include <stdexcept>

#include "core/signals.hpp"
#include "mpi_master/communication/agreement.hpp"
#include "mpi_master/scheduling/back_off.hpp"
#include "solver/channels.hpp"

namespace fluxel {

namespace {

/// In a part, so that none of the threads idles for long at its end.
constexpr std::size_t kMinTileRowsPerThread = 8;

template <class Value>
constexpr bool kGrey = kChannelsOf<Value> == 1;

TileRows part_of(const TileRows& rows, std::size_t part, std::size_t parts) {
  return {rows.first + rows.size() * part / parts, rows.first + rows.size() * (part + 1) / parts};
}

}  // namespace

/// A vector's way to the other hosts, as a leader sees it: a part goes when all ranks of the host have done
/// it, and all leaders send parts in the same order.
template <class Value>
class DistributedOperator::VectorGather {
 public:
  VectorGather(DistributedOperator& all, std::span<Value> values, std::size_t parts)
      : all_(all), leaders_(all.communicator_.leaders()), values_(values), parts_(parts) {}

  void advance() {
    for (; next_ < parts_ && all_.team_.is_finished(next_); ++next_) start(next_);
    leaders_.advance_gathers();
  }

  void finish() {
    using Clock = std::chrono::steady_clock;
    const Clock::time_point begin = Clock::now();
    advance();
    for (BackOff pause; next_ < parts_; advance()) pause.wait();
    leaders_.finish_gathers();
    GatherCounts& counts = all_.gathered_;
    counts.wait_seconds += std::chrono::duration<double>(Clock::now() - begin).count();
    if (leaders_.size() == 1) return;
    std::size_t here = 0;
    const ItemRange& ranks = all_.communicator_.hosts()[static_cast<std::size_t>(leaders_.rank())];
    for (std::size_t k = 0; k < ranks.count; ++k)
      here += all_.elements_of(all_.of_ranks_[ranks.first + k]).count;
    counts.bytes += all_.sides_ * (all_.elements_ - here) * sizeof(Value);
    ++counts.gathers;
  }

 private:
  /// The ranks' shares of a part do not touch, so each place on the hosts has its own gathering.
  void start(std::size_t part) {
    if (leaders_.size() == 1) return;
    for (std::size_t place = 0; place < all_.max_ranks_on_host_; ++place) {
      std::vector<ItemRange> ranges;
      for (const ItemRange& ranks : all_.communicator_.hosts())
        ranges.push_back(place < ranks.count
                             ? all_.elements_of(part_of(all_.of_ranks_[ranks.first + place], part, parts_))
                             : ItemRange{});
      for (std::size_t side = 0; side < all_.sides_; ++side)
        leaders_.start_gather(values_.subspan(side * all_.elements_, all_.elements_),
                              std::span<const ItemRange>(ranges));
    }
  }

  DistributedOperator& all_;
  const Communicator& leaders_;
  std::span<Value> values_;
  std::size_t parts_;
  std::size_t next_ = 0;
};

DistributedOperator::DistributedOperator(const Communicator& communicator, RowOperator& rows,
                                         std::size_t elements, bool two_sided, int threads)
    : communicator_(communicator),
      rows_(rows),
      elements_(elements),
      sides_(two_sided ? 2 : 1),
      team_(communicator.host()) {
  const TileRows mine = rows.owned();
  of_ranks_ = communicator.all_gather(std::span(&mine, 1));
  for (const ItemRange& ranks : communicator.hosts())
    max_ranks_on_host_ = std::max(max_ranks_on_host_, ranks.count);
  // The same on all ranks, since parts are gathered together.
  std::uint64_t parts = mine.size() / (kMinTileRowsPerThread * static_cast<std::size_t>(threads));
  communicator.all_min(std::span(&parts, 1));
  parts_ = std::clamp<std::size_t>(parts, 1, HostTeam::kMaxParts);
  if (team_.has_helpers())
    vectors_ = SharedArray<Rgb>(communicator.host(), kSharedVectors * sides_ * elements_);
}

void DistributedOperator::lead(const std::function<void()>& work) {
  agree(communicator_, [&] {
    if (!communicator_.is_leader()) return serve();
    leading_ = true;
    try {
      work();
    } catch (const InputError&) {
      call(TeamTask::end);
      throw;
    } catch (const StopRequest&) {
      call(TeamTask::stop);
      throw;
    }
    call(TeamTask::end);
  });
}

void DistributedOperator::apply(std::span<const Rgb> x, std::span<Rgb> H) { apply_to(x, H); }
void DistributedOperator::apply(std::span<const double> x, std::span<double> H) { apply_to(x, H); }

void DistributedOperator::sweep(std::span<const Rgb> E, std::span<const Rgb> rho, std::span<Rgb> x) {
  sweep_over(E, rho, x);
}
void DistributedOperator::sweep(std::span<const double> E, std::span<const double> rho, std::span<double> x) {
  sweep_over(E, rho, x);
}

template <class Value>
void DistributedOperator::apply_to(std::span<const Value> x, std::span<Value> H) {
  if (communicator_.size() == 1) return rows_.apply(x, H);
  const bool alone = !team_.has_helpers();
  const std::span<const Value> from = alone ? x : shared<Value>(Shared::x);
  const std::span<Value> to = alone ? H : shared<Value>(Shared::H);
  if (!alone) std::ranges::copy(x, shared<Value>(Shared::x).begin());
  call(kGrey<Value> ? TeamTask::apply_grey : TeamTask::apply_rgb);
  VectorGather<Value> gather(*this, to, parts_);
  apply_own_rows<Value>(from, to, [&] { gather.advance(); });
  gather.finish();
  if (!alone) std::ranges::copy(to, H.begin());
}

template <class Value>
void DistributedOperator::sweep_over(std::span<const Value> E, std::span<const Value> rho,
                                     std::span<Value> x) {
  if (communicator_.size() == 1) return rows_.sweep(E, rho, x);
  if (team_.has_helpers()) {
    std::ranges::copy(E, shared<Value>(Shared::E).begin());
    std::ranges::copy(rho, shared<Value>(Shared::rho).begin());
    std::ranges::copy(x, shared<Value>(Shared::x).begin());
    call(kGrey<Value> ? TeamTask::sweep_grey : TeamTask::sweep_rgb);
    sweep_own_rows<Value>();
    VectorGather<Value>(*this, shared<Value>(Shared::H), 1).finish();
    std::ranges::copy(shared<Value>(Shared::H), x.begin());
  } else {
    call(kGrey<Value> ? TeamTask::sweep_grey : TeamTask::sweep_rgb);
    rows_.sweep(E, rho, x);
    team_.finish(0);
    VectorGather<Value>(*this, x, 1).finish();
  }
}

template <class Value>
void DistributedOperator::apply_own_rows(std::span<const Value> x, std::span<Value> H,
                                         const std::function<void()>& after_part) {
  rows_.start(x);
  for (std::size_t part = 0; part < parts_; ++part) {
    rows_.apply_rows(part_of(rows_.owned(), part, parts_), H);
    team_.finish(part);
    after_part();
  }
}

/// The other ranks' rows must keep the values that they had, so each rank sweeps over a copy.
template <class Value>
void DistributedOperator::sweep_own_rows() {
  const std::span<const Value> x = shared<Value>(Shared::x);
  std::vector<Value> own(x.begin(), x.end());
  rows_.sweep(shared<Value>(Shared::E), shared<Value>(Shared::rho), std::span<Value>(own));
  const ItemRange mine = elements_of(rows_.owned());
  for (std::size_t side = 0; side < sides_; ++side) {
    const std::size_t first = side * elements_ + mine.first;
    std::ranges::copy(std::span(own).subspan(first, mine.count),
                      shared<Value>(Shared::H).subspan(first).begin());
  }
  team_.finish(0);
}

void DistributedOperator::call(TeamTask task) {
  if (team_.has_helpers() && !leading_)
    throw std::logic_error("the ranks of a host work together inside DistributedOperator::lead alone");
  if (task == TeamTask::end || task == TeamTask::stop) leading_ = false;
  team_.call(task);
  if (team_.is_stop_wished()) request_stop();
}

void DistributedOperator::serve() {
  while (true) {
    const TeamTask task = team_.next();
    if (stop_requested()) team_.wish_to_stop();
    switch (task) {
      case TeamTask::apply_grey:
        apply_own_rows<double>(shared<double>(Shared::x), shared<double>(Shared::H), [] {});
        break;
      case TeamTask::apply_rgb:
        apply_own_rows<Rgb>(shared<Rgb>(Shared::x), shared<Rgb>(Shared::H), [] {});
        break;
      case TeamTask::sweep_grey:
        sweep_own_rows<double>();
        break;
      case TeamTask::sweep_rgb:
        sweep_own_rows<Rgb>();
        break;
      case TeamTask::end:
        return;
      case TeamTask::stop:
        throw StopRequest("the leader has been asked to stop");
    }
  }
}

template <class Value>
std::span<Value> DistributedOperator::shared(Shared vector) {
  const std::size_t unknowns = sides_ * elements_;
  const std::span<Rgb> whole =
      vectors_.items().subspan(static_cast<std::size_t>(vector) * unknowns, unknowns);
  // One channel takes a third of it.
  return {reinterpret_cast<Value*>(whole.data()), unknowns};
}

ItemRange DistributedOperator::elements_of(const TileRows& rows) const {
  const std::size_t first = std::min(rows.first * kTileSize, elements_);
  return {first, std::min(rows.last * kTileSize, elements_) - first};
}

}  // namespace fluxel
