#include "formfactor/view_factor_table.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fluxel {

namespace {

/// Rows that are made together: what they have of an earlier surface's list stands there side by side.
constexpr std::size_t kRowsAtOnce = 64;

/// Of a surface's exchange. Every pair of its own faces sends both ways inside it.
SurfaceViewFactor factor_of(const SurfaceExchange& entry, std::uint32_t from, std::uint32_t to, double area) {
  const double times = entry.from == entry.to ? 2 : 1;
  return {from, to, times * entry.G / area, times * entry.total_error() / area};
}

/// Where the exchanges of each surface with itself and later ones begin, and at the end of all.
std::vector<std::size_t> first_exchanges(const ExchangeTable& table) {
  std::vector<std::size_t> first(table.areas.size() + 1, table.exchanges.size());
  for (std::size_t k = table.exchanges.size(); k-- > 0;) first[table.exchanges[k].from] = k;
  for (std::size_t surface = table.areas.size(); surface-- > 0;)
    first[surface] = std::min(first[surface], first[surface + 1]);
  return first;
}

}  // namespace

void visit_rows(const ExchangeTable& table,
                const std::function<void(std::span<const SurfaceViewFactor>)>& visit) {
  const auto& [exchanges, areas] = table;
  const std::vector<std::size_t> first = first_exchanges(table);
  std::vector<std::size_t> next(first.begin(), first.end() - 1);
  std::vector<std::vector<SurfaceViewFactor>> rows(kRowsAtOnce);
  for (std::size_t begin = 0; begin < areas.size(); begin += kRowsAtOnce) {
    const std::size_t end = std::min(begin + kRowsAtOnce, areas.size());
    // Of a row first come the exchanges with earlier surfaces, which are in their order.
    for (std::uint32_t from = 0; from < end; ++from) {
      for (; next[from] < first[from + 1] && exchanges[next[from]].to < end; ++next[from]) {
        const SurfaceExchange& entry = exchanges[next[from]];
        if (entry.to != from)
          rows[entry.to - begin].push_back(factor_of(entry, entry.to, from, areas[entry.to]));
      }
      if (from < begin) continue;
      for (std::size_t k = first[from]; k < first[from + 1]; ++k)
        rows[from - begin].push_back(factor_of(exchanges[k], from, exchanges[k].to, areas[from]));
    }
    for (std::vector<SurfaceViewFactor>& row : rows) {
      if (!row.empty()) visit(row);
      row.clear();
    }
  }
}

std::size_t count_view_factors(std::span<const SurfaceExchange> exchanges) {
  std::size_t count = 0;
  for (const SurfaceExchange& entry : exchanges) count += entry.from == entry.to ? 1 : 2;
  return count;
}

std::vector<SurfaceViewFactor> view_factors_of(const ExchangeTable& table) {
  std::vector<SurfaceViewFactor> factors;
  factors.reserve(count_view_factors(table.exchanges));
  visit_rows(table, [&](std::span<const SurfaceViewFactor> row) {
    factors.insert(factors.end(), row.begin(), row.end());
  });
  return factors;
}

std::vector<double> row_sums(const ExchangeTable& table) {
  // The exchanges' order is that of each row too.
  std::vector<double> sums(table.areas.size(), 0.0);
  for (const SurfaceExchange& entry : table.exchanges) {
    sums[entry.from] += factor_of(entry, entry.from, entry.to, table.areas[entry.from]).value;
    if (entry.from != entry.to)
      sums[entry.to] += factor_of(entry, entry.to, entry.from, table.areas[entry.to]).value;
  }
  return sums;
}

ViewFactorChecks check_view_factors(const ExchangeTable& table) {
  const auto& [exchanges, areas] = table;
  const std::vector<double> sums = row_sums(table);
  ViewFactorChecks checks;
  for (const SurfaceExchange& entry : exchanges) {
    const SurfaceViewFactor there = factor_of(entry, entry.from, entry.to, areas[entry.from]);
    const SurfaceViewFactor back = factor_of(entry, entry.to, entry.from, areas[entry.to]);
    checks.max_error = std::max({checks.max_error, there.error, back.error});
    const double sent = areas[entry.from] * there.value, returned = areas[entry.to] * back.value;
    checks.reciprocity = std::max(checks.reciprocity, std::abs(sent - returned) / std::max(sent, returned));
  }
  double area = 0, seen = 0, least = std::numeric_limits<double>::infinity();
  for (std::size_t surface = 0; surface < areas.size(); ++surface) {
    if (areas[surface] == 0) continue;
    if (sums[surface] == 0) {
      ++checks.blind;
      continue;
    }
    least = std::min(least, sums[surface]);
    checks.max_row_sum = std::max(checks.max_row_sum, sums[surface]);
    seen += areas[surface] * sums[surface];
    area += areas[surface];
  }
  if (area > 0) {
    checks.min_row_sum = least;
    checks.mean_row_sum = seen / area;
  }
  return checks;
}

}  // namespace fluxel
