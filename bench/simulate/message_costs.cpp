#include "bench/simulate/message_costs.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <limits>

#include "bench/visibility/stopwatch.hpp"
#include "mpi_master/scheduling/tile_messages.hpp"
#include "solver/error_bound.hpp"
#include "solver/iterate.hpp"
#include "visibility/tile_store.hpp"

namespace fluxel::bench {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

constexpr int kTag = 100;
constexpr std::size_t kRepetitions = 20;
constexpr std::size_t kMessages = 200;  // few enough that none waits for room

Message wait_for_message(const Communicator& world) {
  while (true)
    if (auto message = world.receive()) return std::move(*message);
}

void wait_for_sends(const Communicator& world) {
  while (world.pending_sends() > 0) {
  }
}

/// The least of some repetitions [s]: other programs only make it longer.
template <class Action>
double least_seconds(const Action& action) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < kRepetitions; ++k) least = std::min(least, action());
  return least;
}

/// Half a round trip of a message of this size.
double one_way(const Communicator& world, std::size_t bytes, std::size_t trips) {
  return least_seconds([&] {
    world.barrier();
    const auto start = Clock::now();
    for (std::size_t k = 0; k < trips; ++k) {
      if (world.rank() == 0) world.send(1, kTag, Bytes(bytes));
      if (world.rank() < 2) static_cast<void>(wait_for_message(world));
      if (world.rank() == 1) world.send(0, kTag, Bytes(bytes));
      wait_for_sends(world);
    }
    return seconds_since(start) / static_cast<double>(2 * trips);
  });
}

/// Processor time in the calls that send, and in those that receive what has arrived already.
void measure_calls(const Communicator& world, MessageCosts& costs) {
  constexpr std::size_t kBytes = 400;  // as batches' messages have on many ranks
  std::array<double, 2> least{std::numeric_limits<double>::infinity(),
                              std::numeric_limits<double>::infinity()};
  for (std::size_t repetition = 0; repetition < kRepetitions; ++repetition) {
    world.barrier();
    if (world.rank() == 0) {
      const double seconds = thread_seconds_of([&] {
        for (std::size_t k = 0; k < kMessages; ++k) world.send(1, kTag, Bytes(kBytes));
        static_cast<void>(world.pending_sends());
      });
      least[0] = std::min(least[0], seconds / kMessages);
    }
    wait_for_sends(world);
    world.barrier();
    if (world.rank() == 1) {
      const double seconds = thread_seconds_of([&] {
        for (std::size_t k = 0; k < kMessages; ++k) static_cast<void>(wait_for_message(world));
      });
      least[1] = std::min(least[1], seconds / kMessages);
    }
  }
  world.all_min(least);
  costs.send = least[0];
  costs.receive = least[1];
}

/// Tiles as they are where clusters see one another in part: a third has bits, in codes of some 100 bytes.
std::vector<CodedTile> some_tiles(std::size_t count) {
  TileBits bits{};
  for (std::size_t row = 0; row < kTileSize; ++row) bits[row] = ~std::uint64_t{0} << (row / 4 * 3);
  std::vector<CodedTile> tiles(count);
  for (std::size_t k = 0; k < count; k += 3) tiles[k] = {TileTag::bits, encode_tile(bits)};
  return tiles;
}

void measure_tiles(MessageCosts& costs) {
  constexpr std::size_t kTiles = 4096, kPart = 16;  // a part of a row for an owner of columns
  const std::vector<CodedTile> tiles = some_tiles(kTiles);
  Bytes message;
  const auto append_all = [&] {
    for (std::size_t first = 0; first < kTiles; first += kPart)
      append_tiles(message, 0, first, std::span(tiles).subspan(first, kPart));
  };
  const double out = least_seconds([&] {
    message.clear();
    return thread_seconds_of(append_all);
  });
  const double in = least_seconds([&] {
    TileStore store(kTiles, {0, 1});
    return thread_seconds_of([&] {
      decode_tiles(message, [&](std::size_t row, std::size_t column, TileTag tag,
                                std::span<const std::byte> code) { store.put(row, column, tag, code); });
    });
  });
  costs.tile_out = out / kTiles;
  costs.tile_in = in / kTiles;
}

/// H_i = d_i x_i: next to nothing beside the vectors, and conjugate gradients need many iterations.
class Diagonal final : public RadiosityOperator {
 public:
  explicit Diagonal(std::size_t unknowns) : factors_(unknowns) {
    for (std::size_t i = 0; i < unknowns; ++i)
      factors_[i] = 0.99 * static_cast<double>(i * 7919 % unknowns) / static_cast<double>(unknowns);
  }
  void apply(std::span<const Rgb> x, std::span<Rgb> H) override { multiply(x, H); }
  void apply(std::span<const double> x, std::span<double> H) override { multiply(x, H); }
  void sweep(std::span<const Rgb> /*E*/, std::span<const Rgb> /*rho*/, std::span<Rgb> /*x*/) override {}
  void sweep(std::span<const double> /*E*/, std::span<const double> /*rho*/,
             std::span<double> /*x*/) override {}

  [[nodiscard]] double seconds() const { return seconds_; }

 private:
  template <class Value>
  void multiply(std::span<const Value> x, std::span<Value> H) {
    seconds_ += thread_seconds_of([&] {
      for (std::size_t i = 0; i < x.size(); ++i) H[i] = x[i] * factors_[i];
    });
  }

  std::vector<double> factors_;
  double seconds_ = 0;
};

}  // namespace

MeasuredMessages measure_messages(const Communicator& world) {
  MeasuredMessages result;
  constexpr std::size_t kLarge = std::size_t{1} << 22u;
  result.within_host.latency = one_way(world, 16, 100);
  const double large = one_way(world, kLarge, 2);
  result.within_host.bytes_per_second = static_cast<double>(kLarge) / (large - result.within_host.latency);
  measure_calls(world, result.costs);
  measure_tiles(result.costs);
  return result;
}

double measure_vectors(std::size_t unknowns) {
  Unknowns scene;
  scene.elements = scene.active = unknowns;
  scene.E.assign(unknowns, Rgb(1, 0.9, 0.8));
  scene.rho.assign(unknowns, Rgb(0.9, 0.8, 0.7));
  scene.area.assign(unknowns, 1.0);
  Diagonal F(unknowns);
  const RowSums row_sums = find_error_weights(F, scene);
  // Setting up and the check at the end are in both runs.
  const auto run = [&](int iterations, int& done) {
    StopRule stop;
    stop.tolerance = 1e-14;
    stop.max_iterations = iterations;
    const double before = F.seconds();
    const double seconds = thread_seconds_of([&] {
      done =
          solve_radiosity(Solver::conjugate_gradients, {F, scene, row_sums}, stop, [](const IterationState&) {
          }).iterations;
    });
    return seconds - (F.seconds() - before);
  };
  int few = 0, many = 0;
  const double short_run = run(2, few), long_run = run(10, many);
  return (long_run - short_run) / (many - few) / static_cast<double>(unknowns);
}

}  // namespace fluxel::bench
