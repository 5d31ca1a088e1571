#include "mpi_master/steps/distributed_operator.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <stdexcept>

#include "host_shapes.hpp"
#include "mpi_master/communication/agreement.hpp"
#include "mpi_master/steps/subdivision_job.hpp"
#include "mpi_master/steps/visibility_job.hpp"
#include "small_scenes.hpp"
#include "solver/cuda/host_rows.hpp"
#include "solver/cuda/row_matrix.hpp"
#include "solver/iterate.hpp"
#include "solver/row_device.hpp"
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
  TileStore whole;
  Corrections none;
  RowOperator own_rows, serial;
  DistributedOperator distributed;

  Operators(const Communicator& on_hosts, const SolveRequest& request, int threads)
      : ranks(on_hosts),
        scene(scene_of(request)),
        subdivided(subdivide_scene(ranks, scene, request.options, 1)),
        elements(subdivided.mesh.elements),
        unknowns(make_unknowns(elements, scene.materials)),
        ray_scene(scene, 1),
        visibility(compute(threads)),
        whole(whole_store(ray_scene, elements)),
        own_rows(elements, visibility.store, none, PairRule::disc, unknowns.two_sided, threads),
        serial(elements, whole, none, PairRule::disc, unknowns.two_sided, 1),
        distributed(ranks, own_rows, elements.size(), unknowns.two_sided, threads) {}

  [[nodiscard]] Visibility compute(int threads) const {
    SilentProgress progress;
    return compute_visibility({ranks, threads, progress}, TileTracer(ray_scene, elements),
                              RowCosts::even(tile_count(elements.size()), 1e-4));
  }

  Radiosity solve(RadiosityOperator& F, Solver solver, double tolerance) const {
    const RowSums sums = find_error_weights(F, unknowns);
    return solve_radiosity(solver, {F, unknowns, sums}, {tolerance, 1000}, [](const IterationState&) {});
  }
};

std::vector<Rgb> random_vector(std::size_t size) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> value(0, 1);
  std::vector<Rgb> x(size);
  for (Rgb& entry : x) entry = {value(random), value(random), value(random)};
  return x;
}

TEST(DistributedOperator, ApplyEqualsSerialApplyToTheLastBit) {
  for (const HostShape& shape : host_shapes()) {
    for (const NamedRequest& named : small_requests()) {
      for (const int threads : {1, 2}) {
        SCOPED_TRACE(shape.name + ", " + named.name);
        Operators operators(shape.world, named.request, threads);
        const std::vector<Rgb> x = random_vector(operators.unknowns.size());
        std::vector<Rgb> serial(x.size(), Rgb(-1)), distributed(x.size(), Rgb(-2));
        operators.serial.apply(x, serial);
        operators.distributed.lead([&] { operators.distributed.apply(x, distributed); });
        EXPECT_EQ(serial == distributed, shape.world.is_leader());
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

TEST(DistributedOperator, GpusInSomeRanksAgreeAndMayFail) {
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
      if (world().rank() % 2 == 0) operators.own_rows.use(device);
      const std::vector<Rgb> x = random_vector(operators.unknowns.size());
      std::vector<Rgb> serial(x.size()), distributed(x.size());
      operators.serial.apply(x, serial);
      double largest = 0, error = 0;
      for (int repeat = 0; repeat < 2; ++repeat) {
        operators.distributed.lead([&] { operators.distributed.apply(x, distributed); });
        if (!world().is_leader()) continue;
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

TEST(DistributedOperator, OneChannelHasTheBytesOfSerialRgb) {
  for (const HostShape& shape : host_shapes()) {
    for (const NamedRequest& named : small_requests()) {
      SCOPED_TRACE(shape.name + ", " + named.name);
      Operators operators(shape.world, named.request, 2);
      const std::vector<Rgb> x = random_vector(operators.unknowns.size());
      std::vector<double> x_green, green, distributed(x.size(), -2);
      for (const Rgb& value : x) x_green.push_back(value.g);
      std::vector<Rgb> serial(x.size());
      operators.serial.apply(x, serial);
      for (const Rgb& value : serial) green.push_back(value.g);
      operators.distributed.lead([&] { operators.distributed.apply(x_green, distributed); });
      EXPECT_EQ(distributed == green, shape.world.is_leader());
    }
  }
}

TEST(DistributedOperator, SolutionsEqualSerialOnesToTheLastBit) {
  for (const HostShape& shape : host_shapes()) {
    for (const NamedRequest& named : small_requests()) {
      SCOPED_TRACE(shape.name + ", " + named.name);
      Operators operators(shape.world, named.request, 1);
      for (const Solver solver : {Solver::jacobi, Solver::conjugate_gradients, Solver::southwell}) {
        const Radiosity serial = operators.solve(operators.serial, solver, 1e-3);
        operators.distributed.lead([&] {
          const Radiosity distributed = operators.solve(operators.distributed, solver, 1e-3);
          EXPECT_EQ(serial.iterations, distributed.iterations);
          EXPECT_TRUE(serial.B == distributed.B);
          EXPECT_TRUE(serial.H == distributed.H);
        });
      }
    }
  }
}

// Enough rows on each of up to three ranks for a part to travel while the next one is computed.
TEST(DistributedOperator, PartsMakeTheBytesOfTheWhole) {
  for (const HostShape& shape : host_shapes()) {
    SCOPED_TRACE(shape.name);
    Operators operators(
        shape.world, scene_request("emitting-wall", {"--subdivision", "uniform", "--max-edge", "0.04"}), 1);
    const std::vector<Rgb> x = random_vector(operators.unknowns.size());
    std::vector<Rgb> serial(x.size(), Rgb(-1)), distributed(x.size(), Rgb(-2));
    operators.serial.apply(x, serial);
    operators.distributed.lead([&] {
      for (int repeat = 0; repeat < 3; ++repeat) {
        operators.distributed.apply(x, distributed);
        EXPECT_TRUE(serial == distributed);
      }
    });
    const bool travels = shape.world.is_leader() && shape.world.hosts().size() > 1;
    EXPECT_EQ(operators.distributed.gathered().gathers, travels ? 3u : 0u);
  }
}

TEST(DistributedOperator, GaussSeidelAgreesWithinTheTolerance) {
  constexpr double kTolerance = 1e-6;
  for (const NamedRequest& named : small_requests()) {
    SCOPED_TRACE(named.name);
    std::vector<Rgb> of_one_host;
    for (const HostShape& shape : host_shapes()) {
      SCOPED_TRACE(shape.name);
      Operators operators(shape.world, named.request, 1);
      const Radiosity serial = operators.solve(operators.serial, Solver::gauss_seidel, kTolerance);
      Radiosity distributed;
      operators.distributed.lead(
          [&] { distributed = operators.solve(operators.distributed, Solver::gauss_seidel, kTolerance); });
      if (!shape.world.is_leader()) continue;
      ASSERT_TRUE(serial.converged);
      ASSERT_TRUE(distributed.converged);
      if (world().size() == 1) {
        EXPECT_TRUE(serial.B == distributed.B);
      }
      // The blocks are the ranks', on whatever hosts they are.
      if (of_one_host.empty()) of_one_host = distributed.B;
      EXPECT_TRUE(of_one_host == distributed.B);
      // Each is within the tolerance of the exact solution.
      const Rgb mean = area_mean(operators.unknowns, serial.B);
      double largest = 0;
      for (std::size_t i = 0; i < serial.B.size(); ++i)
        for (int c = 0; c < kChannels; ++c)
          largest = std::max(largest, std::abs(serial.B[i][c] - distributed.B[i][c]) / mean[c]);
      EXPECT_LE(largest, 2 * kTolerance);
    }
  }
}

TEST(DistributedOperator, CountsWhatItReceives) {
  for (const HostShape& shape : host_shapes()) {
    SCOPED_TRACE(shape.name);
    Operators operators(shape.world, two_squares(), 1);
    std::vector<Rgb> x(operators.unknowns.size(), Rgb(1)), H(x.size());
    operators.distributed.lead([&] { operators.distributed.apply(x, H); });
    // Two elements are one tile: one host owns both rows and receives nothing, the others receive both.
    std::uint64_t received = operators.distributed.gathered().bytes;
    world().all_sum(std::span(&received, 1));
    EXPECT_EQ(received, (shape.world.hosts().size() - 1) * 2 * sizeof(Rgb));
  }
}

TEST(DistributedOperator, AnInputErrorOfTheLeadersIsEverybodys) {
  for (const HostShape& shape : host_shapes()) {
    SCOPED_TRACE(shape.name);
    Operators operators(shape.world, two_squares(), 1);
    std::vector<Rgb> x(operators.unknowns.size(), Rgb(1)), H(x.size());
    const auto fail = [&] {
      operators.distributed.apply(x, H);
      throw InputError("as planted");
    };
    EXPECT_THROW(operators.distributed.lead(fail), AgreedError);
    // And all are ready for more.
    operators.distributed.lead([&] { operators.distributed.apply(x, H); });
    EXPECT_EQ(H.front().r > 0, shape.world.is_leader());
  }
}

TEST(DistributedOperator, AStopOfTheLeadersIsEverybodys) {
  for (const HostShape& shape : host_shapes()) {
    SCOPED_TRACE(shape.name);
    Operators operators(shape.world, two_squares(), 1);
    const auto stop = [] { throw StopRequest("as planted"); };
    EXPECT_THROW(operators.distributed.lead(stop), StopRequest);
  }
}

TEST(DistributedOperator, IsAppliedInsideLeadAloneWhereAHostHasSeveralRanks) {
  Operators operators(world(), two_squares(), 1);
  std::vector<Rgb> x(operators.unknowns.size(), Rgb(1)), H(x.size());
  if (world().size() == 1) {
    EXPECT_NO_THROW(operators.distributed.apply(x, H));
  } else {
    EXPECT_THROW(operators.distributed.apply(x, H), std::logic_error);
  }
}

}  // namespace
}  // namespace fluxel::test
