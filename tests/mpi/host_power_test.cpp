#include "mpi_master/steps/host_power.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

#include "host_shapes.hpp"
#include "mpi_master/steps/own_rows.hpp"
#include "mpi_master/steps/subdivision_job.hpp"
#include "mpi_master/steps/visibility_job.hpp"
#include "small_scenes.hpp"
#include "solver/cuda/host_rows.hpp"
#include "solver/cuda/row_matrix.hpp"
#include "solver/iterate.hpp"
#include "solver/row_device.hpp"
#include "solver/row_operator.hpp"
#include "visibility/tile_tracer.hpp"
#include "world.hpp"

namespace fluxel::test {
namespace {

/// Every tile in one store, as on a single rank.
TileStore whole_store(const RayScene& ray_scene, std::span<const Element> elements) {
  const std::size_t tiles = tile_count(elements.size());
  TileStore store(tiles, {0, tiles});
  const TileTracer tracer(ray_scene, elements);
  for (std::size_t row = 0; row < tiles; ++row) {
    for (std::size_t column = row; column < tiles; ++column) {
      const TracedTile tile = tracer.trace(row, column);
      store.put(row, column, tile.tag, tile.bits);
    }
  }
  return store;
}

/// The same operator twice: its rows assigned to the ranks of some hosts, and all on this rank.
struct Operators {
  Communicator ranks;
  Scene scene;
  SubdividedScene subdivided;
  std::span<const Element> elements;
  Unknowns unknowns;
  RayScene ray_scene;
  Visibility visibility;
  OwnRows own;
  Unknowns own_unknowns;
  TileStore whole;
  Corrections none;
  HostPower power;
  RowOperator serial, distributed;

  Operators(const Communicator& on_hosts, const SolveRequest& request, int threads)
      : ranks(on_hosts),
        scene(scene_of(request)),
        subdivided(subdivide_scene(ranks, scene, request.options, 1)),
        elements(subdivided.mesh.elements),
        unknowns(make_unknowns(elements, scene.materials)),
        ray_scene(scene, 1),
        visibility(compute(threads)),
        own(visibility.store.owned(), elements.size(), unknowns.two_sided),
        own_unknowns(make_unknowns(own.of_elements(elements), scene.materials, unknowns.two_sided)),
        whole(whole_store(ray_scene, elements)),
        power(ranks, visibility.store.owned(), unknowns.two_sided),
        serial(elements, whole, none, PairRule::disc, unknowns.two_sided, 1),
        distributed(elements, visibility.store, none, PairRule::disc, unknowns.two_sided, threads) {
    distributed.use(power);
  }

  /// F x by the ranks, of all unknowns.
  template <class Value>
  [[nodiscard]] std::vector<Value> apply(const std::vector<Value>& x) {
    const std::vector<Value> own_x = own.of(std::span<const Value>(x));
    std::vector<Value> H(own_x.size(), Value(-2));
    distributed.apply(std::span<const Value>(own_x), std::span<Value>(H));
    return gathered(H);
  }

  template <class Value>
  [[nodiscard]] std::vector<Value> gathered(const std::vector<Value>& mine) const {
    const SharedArray<Value> all = own.gather(ranks, mine);
    return {all.items().begin(), all.items().end()};
  }

  [[nodiscard]] Visibility compute(int threads) const {
    SilentProgress progress;
    return compute_visibility({ranks, threads, progress}, TileTracer(ray_scene, elements),
                              RowCosts::even(tile_count(elements.size()), 1e-4));
  }

  static Radiosity solve(RadiosityOperator& F, const Unknowns& of, Solver solver, const StopRule& stop) {
    const RowSums sums = find_error_weights(F, of);
    return solve_radiosity(solver, {F, of, sums}, stop, [](const IterationState&) {});
  }
};

std::vector<Rgb> random_vector(std::size_t size) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> value(0, 1);
  std::vector<Rgb> x(size);
  for (Rgb& entry : x) entry = {value(random), value(random), value(random)};
  return x;
}

TEST(HostPower, ApplyEqualsSerialApplyToTheLastBit) {
  for (const HostShape& shape : host_shapes()) {
    for (const NamedRequest& named : small_requests()) {
      for (const int threads : {1, 2}) {
        SCOPED_TRACE(shape.name + ", " + named.name);
        Operators operators(shape.world, named.request, threads);
        const std::vector<Rgb> x = random_vector(operators.unknowns.size());
        std::vector<Rgb> serial(x.size(), Rgb(-1));
        operators.serial.apply(x, serial);
        EXPECT_TRUE(serial == operators.apply(x));
        EXPECT_TRUE(std::ranges::any_of(serial, [](const Rgb& H) { return H.r > 0; }));
      }
    }
  }
}

/// The GPU's rows, made by the host, until the calls are used up.
class ScriptedRows final : public cuda::RowGatherer {
 public:
  ScriptedRows(const cuda::RowMatrix& matrix, int calls) : rows_(matrix), calls_(calls) {}

  void start(const float* power, const std::uint8_t* sends, std::uint32_t channels) override {
    rows_.start(power, sends, channels);
  }
  [[nodiscard]] const double* gather(std::uint32_t first, std::uint32_t last) override {
    if (calls_-- == 0) throw cuda::DeviceError("the GPU could not gather rows: planted");
    return rows_.gather(first, last);
  }
  [[nodiscard]] cuda::DeviceSeconds seconds() const override { return {}; }

 private:
  cuda::HostRows rows_;
  int calls_;
};

TEST(HostPower, GpusInSomeRanksAgreeAndMayFail) {
  for (const int calls : {1'000'000, 1}) {
    for (const NamedRequest& named : small_requests()) {
      SCOPED_TRACE(named.name);
      Operators operators(world(), named.request, 1);
      const PairColumns columns(operators.elements);
      int failures = 0;
      // Ranks in the middle may own no rows; the last has one.
      const cuda::RowMatrix matrix = row_matrix(operators.elements, columns, operators.visibility.store,
                                                PairRule::disc, operators.unknowns.two_sided);
      RowDevice device(std::make_unique<ScriptedRows>(matrix, calls),
                       [&failures](const cuda::DeviceError&) { ++failures; });
      if (world().rank() % 2 == 0) operators.distributed.use(device);
      const std::vector<Rgb> x = random_vector(operators.unknowns.size());
      std::vector<Rgb> serial(x.size());
      operators.serial.apply(x, serial);
      double largest = 0, error = 0;
      for (int repeat = 0; repeat < 2; ++repeat) {
        const std::vector<Rgb> distributed = operators.apply(x);
        for (std::size_t i = 0; i < x.size(); ++i) {
          largest = std::max({largest, serial[i].r, serial[i].g, serial[i].b});
          const Rgb difference = serial[i] - distributed[i];
          error = std::max({error, std::abs(difference.r), std::abs(difference.g), std::abs(difference.b)});
        }
      }
      EXPECT_LE(error, 1e-6 * largest);
      EXPECT_LE(failures, world().rank() % 2 == 0 && calls == 1 ? 1 : 0);
      if (calls == 1 && ranks() == 1) {
        EXPECT_EQ(failures, 1);
      }
    }
  }
}

TEST(HostPower, OneChannelHasTheBytesOfSerialRgb) {
  for (const HostShape& shape : host_shapes()) {
    for (const NamedRequest& named : small_requests()) {
      SCOPED_TRACE(shape.name + ", " + named.name);
      Operators operators(shape.world, named.request, 2);
      const std::vector<Rgb> x = random_vector(operators.unknowns.size());
      std::vector<double> x_green, green;
      for (const Rgb& value : x) x_green.push_back(value.g);
      std::vector<Rgb> serial(x.size());
      operators.serial.apply(x, serial);
      for (const Rgb& value : serial) green.push_back(value.g);
      EXPECT_TRUE(operators.apply(x_green) == green);
    }
  }
}

TEST(HostPower, SolutionsEqualSerialOnesToTheLastBit) {
  for (const HostShape& shape : host_shapes()) {
    for (const NamedRequest& named : small_requests()) {
      SCOPED_TRACE(shape.name + ", " + named.name);
      Operators operators(shape.world, named.request, 1);
      const DiscretisationError whole(operators.elements, operators.unknowns);
      const DiscretisationError parts(operators.own.of_elements(operators.elements), operators.own_unknowns,
                                      operators.distributed.ranks());
      for (const Solver solver : {Solver::jacobi, Solver::conjugate_gradients, Solver::southwell}) {
        for (const bool by_discretisation : {false, true}) {
          StopRule stop{1e-3, 1000};
          if (by_discretisation) stop.discretisation = &whole;
          const Radiosity serial = operators.solve(operators.serial, operators.unknowns, solver, stop);
          if (by_discretisation) stop.discretisation = &parts;
          const Radiosity distributed =
              operators.solve(operators.distributed, operators.own_unknowns, solver, stop);
          EXPECT_EQ(serial.iterations, distributed.iterations);
          EXPECT_EQ(serial.error_bound, distributed.error_bound);
          EXPECT_EQ(serial.mean_square_bound, distributed.mean_square_bound);
          EXPECT_EQ(serial.discretisation, distributed.discretisation);
          EXPECT_EQ(serial.residual, distributed.residual);
          EXPECT_TRUE(serial.B == operators.gathered(distributed.B));
          EXPECT_TRUE(serial.H == operators.gathered(distributed.H));
        }
      }
    }
  }
}

// Nobody overwrites what a rank that is late still reads, or reads what is not complete.
TEST(HostPower, ProductsFollowOneAnotherWithoutAWait) {
  for (const HostShape& shape : host_shapes()) {
    SCOPED_TRACE(shape.name);
    Operators operators(
        shape.world, scene_request("emitting-wall", {"--subdivision", "uniform", "--max-edge", "0.06"}), 1);
    const std::vector<Rgb> x = random_vector(operators.unknowns.size());
    std::vector<Rgb> y(x.rbegin(), x.rend()), F_x(x.size()), F_y(x.size());
    operators.serial.apply(x, F_x);
    operators.serial.apply(y, F_y);
    const auto own = [&](const std::vector<Rgb>& all) { return operators.own.of(std::span<const Rgb>(all)); };
    const std::vector<Rgb> own_x = own(x), own_y = own(y);
    std::vector<Rgb> of_x(own_x.size()), of_y(own_x.size());
    bool same = true;
    for (int repeat = 0; repeat < 20; ++repeat) {
      operators.distributed.apply(own_x, of_x);
      operators.distributed.apply(own_y, of_y);
      same = same && of_x == own(F_x) && of_y == own(F_y);
    }
    EXPECT_TRUE(same);
    const bool travels = shape.world.is_leader() && shape.world.hosts().size() > 1;
    EXPECT_EQ(operators.power.gathered().gathers, travels ? 40u : 0u);
  }
}

TEST(HostPower, GaussSeidelAgreesWithinTheTolerance) {
  constexpr double kTolerance = 1e-6;
  for (const NamedRequest& named : small_requests()) {
    SCOPED_TRACE(named.name);
    std::vector<Rgb> of_one_host;
    for (const HostShape& shape : host_shapes()) {
      SCOPED_TRACE(shape.name);
      Operators operators(shape.world, named.request, 1);
      const StopRule stop{kTolerance, 1000};
      const Radiosity serial =
          operators.solve(operators.serial, operators.unknowns, Solver::gauss_seidel, stop);
      const Radiosity own =
          operators.solve(operators.distributed, operators.own_unknowns, Solver::gauss_seidel, stop);
      const std::vector<Rgb> distributed = operators.gathered(own.B);
      ASSERT_TRUE(serial.converged);
      ASSERT_TRUE(own.converged);
      if (world().size() == 1) {
        EXPECT_TRUE(serial.B == distributed);
      }
      // The blocks are the ranks', on whatever hosts they are.
      if (of_one_host.empty()) of_one_host = distributed;
      EXPECT_TRUE(of_one_host == distributed);
      // Each is within the tolerance of the exact solution.
      const Rgb mean = area_mean(operators.unknowns, serial.B);
      double largest = 0;
      for (std::size_t i = 0; i < serial.B.size(); ++i)
        for (int c = 0; c < kChannels; ++c)
          largest = std::max(largest, std::abs(serial.B[i][c] - distributed[i][c]) / mean[c]);
      EXPECT_LE(largest, 2 * kTolerance);
    }
  }
}

TEST(HostPower, CountsWhatItReceives) {
  for (const HostShape& shape : host_shapes()) {
    SCOPED_TRACE(shape.name);
    Operators operators(shape.world, two_squares(), 1);
    static_cast<void>(operators.apply(std::vector<Rgb>(operators.unknowns.size(), Rgb(1))));
    // Two elements are one tile: one host owns both rows and receives nothing, the others receive it, 8 bytes
    // a place and channel, and whether it sends anything.
    std::uint64_t received = operators.power.gathered().bytes;
    world().all_sum(std::span(&received, 1));
    EXPECT_EQ(received,
              (shape.world.hosts().size() - 1) * (operators.own.sides * kChannels * kTileSize * 8 + 1));
  }
}

}  // namespace
}  // namespace fluxel::test
