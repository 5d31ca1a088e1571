#include "bench/solver/row_accuracy.hpp"

#include <fmt/format.h>

#include <cmath>
#include <random>
#include <vector>

#include "bench/visibility/csv_file.hpp"
#include "core/error.hpp"
#include "solver/pair_kernel.hpp"
#include "tests/unit/closed_box.hpp"
#include "visibility/instruction_set.hpp"

namespace fluxel::bench {

namespace {

struct Deviation {
  double squares = 0, largest = 0;
  std::size_t count = 0;

  void add(double value) {
    squares += value * value;
    largest = std::max(largest, std::abs(value));
    ++count;
  }
  [[nodiscard]] double rms() const { return std::sqrt(squares / static_cast<double>(count)); }
};

struct Rule {
  PairRule rule;
  const char* name;
};
constexpr std::array<Rule, 3> kRules{
    {{PairRule::point, "point"}, {PairRule::disc, "disc"}, {PairRule::moments, "moments"}}};

}  // namespace

void run_rows(const AccuracySettings& settings) {
  if (settings.along == 0 || settings.along % 8 != 0 || settings.rows == 0)
    throw InputError("a face needs a multiple of 8 elements along its edges, and one row at least");
  const test_scenes::ClosedBox box(settings.along);
  const PairColumns columns(box.elements);
  const std::vector<FlatShape> shapes = test_scenes::flat_shapes(box.elements);
  const std::vector<float> one(shapes.size(), 1.0f);
  const ColumnPower power = test_scenes::power_of(columns, one);
  std::mt19937_64 random(1);
  std::vector<std::size_t> rows(settings.rows);
  for (std::size_t& row : rows) row = random() % shapes.size();

  CsvFile table(settings.csv);
  const std::vector<Isa> sets = supported_instruction_sets();
  fmt::print("{} elements, {} rows; relative to a row's sum\n{:>8} {:>10} {:>10} {:>10}\n", shapes.size(),
             rows.size(), "rule", "", "rms", "largest");
  for (const Rule& rule : kRules) {
    Deviation missed;
    std::vector<Deviation> lost(sets.size());
    for (const std::size_t i : rows) {
      const double plain = box.plain_row(rule.rule, i, shapes, one);
      missed.add(plain - 1);
      NumberColumns numbers{{"row", static_cast<double>(i)}, {"missed", plain - 1}};
      for (std::size_t k = 0; k < sets.size(); ++k) {
        use_instruction_set(sets[k]);
        const double error = box.kernel_row(rule.rule, i, columns, power) / plain - 1;
        lost[k].add(error);
        numbers.emplace_back(name_of(sets[k]), error);
      }
      table.add({{"rule", rule.name}}, numbers);
    }
    for (std::size_t k = 0; k < sets.size(); ++k)
      fmt::print("{:>8} {:>10} {:10.2e} {:10.2e}\n", rule.name, name_of(sets[k]), lost[k].rms(),
                 lost[k].largest);
    fmt::print("{:>8} {:>10} {:10.2e} {:10.2e}\n", rule.name, "the rule", missed.rms(), missed.largest);
  }
  use_instruction_set(Isa::automatic);
}

}  // namespace fluxel::bench
