// sequences_bench
//
// Times of a million points of five dimensions whose indices grow by steps, a coordinate at a time, as
// Markdown tables: those of Dmitriev (2002), tables 1 and 2. Of each the least of five turns, in which all
// take part.

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "bench/sequences/generators.hpp"

namespace {

using namespace fluxel;
using namespace fluxel::bench;

constexpr std::uint64_t kPoints = 1'000'000;
constexpr std::uint64_t kSteps[] = {1, 2, 20, 200, 2000, 20000};
constexpr int kTurns = 5;

struct Row {
  std::string name;
  std::function<double(std::uint64_t step)> sum;  // of all coordinates
  bool only_one_by_one = false;
  std::vector<double> seconds =
      std::vector<double>(std::size(kSteps), std::numeric_limits<double>::infinity());
};

template <class Generator>
double sum_of(std::uint64_t step) {
  Generator generator;
  double sum = 0;
  for (std::uint64_t k = 0, index = 0; k < kPoints; ++k, index += step) {
    generator.start(index);
    for (std::size_t dimension = 0; dimension < kDimensions; ++dimension) sum += generator.next();
  }
  return sum;
}

void time(std::vector<Row>& rows) {
  for (int turn = 0; turn < kTurns; ++turn)
    for (std::size_t k = 0; k < std::size(kSteps); ++k)
      for (Row& row : rows) {
        if (row.only_one_by_one && kSteps[k] != 1) continue;
        const auto start = std::chrono::steady_clock::now();
        const double sum = row.sum(kSteps[k]);
        const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
        row.seconds[k] = std::min(row.seconds[k], seconds.count());
        if (!(sum > 0)) fmt::print("{} sums to {}\n", row.name, sum);  // so that it is made
      }
}

void print(const std::string& title, const std::vector<Row>& rows, std::size_t plain) {
  fmt::print("| {} |", title);
  for (const std::uint64_t step : kSteps) fmt::print(" l = {} |", step);
  fmt::print("\n| --- |");
  for (std::size_t k = 0; k < std::size(kSteps); ++k) fmt::print(" ---: |");
  fmt::print("\n");
  for (const Row& row : rows) {
    fmt::print("| {} |", row.name);
    for (std::size_t k = 0; k < std::size(kSteps); ++k)
      if (row.only_one_by_one && kSteps[k] != 1)
        fmt::print(" |");
      else
        fmt::print(" {:.1f} ms ({:.2f}) |", 1e3 * row.seconds[k], row.seconds[k] / rows[plain].seconds[k]);
    fmt::print("\n");
  }
  fmt::print("\n");
}

}  // namespace

int main() {
  std::vector<Row> halton{{"plain, base variable", sum_of<PlainHalton>},
                          {"plain, base constant", sum_of<PlainHaltonOfConstants>},
                          {"decomposition (7)", sum_of<DecomposedHalton>},
                          {"recurrent + decomposition", sum_of<RecurrentHalton>},
                          {"table of low digits + decomposition", sum_of<HaltonSequence>},
                          {"Keller", sum_of<KellerHalton>, true}};
  std::vector<Row> sobol{{"plain (9), all digits", sum_of<PlainSobol>},
                         {"plain (9), digits that are 1", sum_of<ShortSobol>},
                         {"recurrent (10)", sum_of<SobolSequence>},
                         {"Gray's code", sum_of<GraySobol>, true},
                         {"pseudo-random, by counter", sum_of<RandomSequence>},
                         {"pseudo-random, Mersenne twister", sum_of<MersenneTwister>}};
  time(halton);
  time(sobol);
  print("Halton", halton, 0);
  print("Sobol", sobol, 0);
}
