#include "bench/view_factors/tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>

#include "bench/view_factors/groups.hpp"
#include "core/error.hpp"
#include "core/file.hpp"
#include "tests/closed_forms/shapes.hpp"

namespace fluxel::bench {

namespace {

using fmt::format_to;

void flush_line(fmt::memory_buffer& line) {
  fmt::print("{}\n", fmt::to_string(line));
  std::fflush(stdout);
  line.clear();
}

void write_csv(const std::string& file, const fmt::memory_buffer& text) {
  if (!file.empty()) write_bytes_atomically(file, fmt::to_string(text));
}

struct Measured {
  double factor = 0;
  double seconds = 0;
};

Measured measure(const closed_forms::Case& view, double tolerance) {
  Groups groups;
  const std::uint32_t from = groups.add("sender", view.sender);
  const std::uint32_t to = view.receiver == view.sender ? from : groups.add("receiver", view.receiver);
  groups.add("blocker", view.blockers);
  const ViewFactors found = find_view_factors(groups.scene(), tolerance);
  return {found.factor(from, to), found.seconds};
}

}  // namespace

void print_known_factors(const std::vector<double>& tolerances, double slow, const std::string& only,
                         const std::string& csv) {
  std::vector<closed_forms::Case> cases = closed_forms::all_cases();
  if (!only.empty()) std::erase_if(cases, [&](const closed_forms::Case& view) { return view.id != only; });
  if (cases.empty()) throw InputError("no case is named " + only);

  fmt::memory_buffer line, text;
  const auto at_line = std::back_inserter(line), at_text = std::back_inserter(text);
  format_to(at_line, "| case | geometry | F");
  for (const double tolerance : tolerances) format_to(at_line, " | T = {:g} | s", tolerance);
  format_to(at_line, " |\n| --- | --- | ---");
  for (std::size_t k = 0; k < tolerances.size(); ++k) format_to(at_line, " | --- | ---");
  format_to(at_line, " |");
  flush_line(line);
  format_to(at_text, "case,geometry,exact,tolerance,found,relative_error,processor_s\n");

  for (const closed_forms::Case& view : cases) {
    const double exact = polygon_truth(view);
    format_to(at_line, "| {} | {} | {:.6f}", view.id, view.what, exact);
    double last_seconds = 0;
    for (const double tolerance : tolerances) {
      if (last_seconds > slow) {
        format_to(at_line, " | - | -");
        continue;
      }
      const auto [factor, seconds] = measure(view, tolerance);
      last_seconds = seconds;
      const double error = factor / exact - 1;
      format_to(at_line, " | {:+.1e} | {:.2f}", error, seconds);
      format_to(at_text, "{},\"{}\",{:.15g},{:g},{:.15g},{:.3e},{:.4f}\n", view.id, view.what, exact,
                tolerance, factor, error, seconds);
    }
    format_to(at_line, " |");
    flush_line(line);
  }
  write_csv(csv, text);
}

void print_nested_cubes(const std::vector<double>& tolerances, int divisions, const std::string& csv) {
  Groups groups;
  for (const closed_forms::Polygon& square : closed_forms::reversed(squares_of_cube(3, divisions)))
    groups.add("outer", {square});
  for (const closed_forms::Polygon& square : squares_of_cube(1, divisions)) groups.add("inner", {square});
  const Scene scene = groups.scene();

  fmt::memory_buffer text;
  fmt::print(
      "| groups | T | factors | largest row-sum error | pairs partly hidden | rays | s |\n"
      "| --- | --- | --- | --- | --- | --- | --- |\n");
  format_to(std::back_inserter(text),
            "groups,tolerance,factors,row_sum_error,hidden_pairs,rays,processor_s\n");
  for (const double tolerance : tolerances) {
    const ViewFactors found = find_view_factors(scene, tolerance);
    double worst = 0;
    for (const double sum : found.row_sums()) worst = std::max(worst, std::abs(sum - 1));
    const std::size_t factors = count_view_factors(found.exchanges);
    const auto hidden_pairs = std::ranges::count_if(
        found.exchanges, [](const SurfaceExchange& entry) { return entry.deviation > 0; });
    fmt::print("| {} | {:g} | {} | {:.1e} | {} | {:.3g} million | {:.2f} |\n", found.areas.size() / 2,
               tolerance, factors, worst, hidden_pairs, 1e-6 * static_cast<double>(found.rays),
               found.seconds);
    std::fflush(stdout);
    format_to(std::back_inserter(text), "{},{:g},{},{:.3e},{},{},{:.4f}\n", found.areas.size() / 2, tolerance,
              factors, worst, hidden_pairs, found.rays, found.seconds);
  }
  write_csv(csv, text);
}

}  // namespace fluxel::bench
