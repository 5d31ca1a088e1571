#include "formfactor/find_corrections.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "formfactor/pair_rule.hpp"

namespace fluxel {

namespace {

struct Entry {
  std::uint32_t row, column;  // unknowns
  float G;
};

/// What can be said of all pairs of two tiles at once.
struct TileBounds {
  glm::vec3 low{std::numeric_limits<float>::infinity()}, high{-std::numeric_limits<float>::infinity()};
  double area = 0;                                     // largest
  double variance = 0;                                 // largest mean squared distance from the centroid
  double power = 0;                                    // largest area times B
  double H = std::numeric_limits<double>::infinity();  // least
};

double squared_gap(const TileBounds& a, const TileBounds& b) {
  const glm::vec3 gap = glm::max(glm::vec3(0), glm::max(a.low - b.high, b.low - a.high));
  return static_cast<double>(glm::dot(gap, gap));
}

/// Finds the corrections of one tile row after another.
class TileExaminer {
 public:
  TileExaminer(const RayScene& ray_scene, const Scene& scene, const ElementMesh& mesh, const TileStore& store,
               const FormFactorOptions& options, const PowerEstimate& power)
      : examiner_(ray_scene, scene, mesh, options, power),
        elements_(mesh.elements),
        store_(store),
        options_(options),
        power_(power),
        bounds_(store.tiles()) {
    for (std::size_t tile = 0; tile < bounds_.size(); ++tile) bounds_[tile] = bounds_of(tile);
  }

  void examine_row(std::size_t row, std::vector<Entry>& entries, CorrectionCounts& counts) const {
    for (std::size_t column = 0; column < store_.tiles(); ++column) {
      // A pair with both rows here is found once, by the lower tile.
      if (column < row && store_.owned().contains(column)) continue;
      if (may_matter(bounds_[row], bounds_[column])) examine_tile(row, column, entries, counts);
    }
  }

 private:
  [[nodiscard]] TileBounds bounds_of(std::size_t tile) const {
    TileBounds bounds;
    for (std::size_t k = 0; k < rows_of_tile(tile, elements_.size()); ++k) {
      const std::size_t i = tile * kTileSize + k;
      const Element& element = elements_[i];
      const auto area = static_cast<double>(element.area);
      bounds.low = glm::min(bounds.low, element.centroid);
      bounds.high = glm::max(bounds.high, element.centroid);
      bounds.area = std::max(bounds.area, area);
      bounds.variance = std::max(
          bounds.variance,
          static_cast<double>(2 * element.spread + glm::dot(element.elongation, element.elongation)));
      for (std::size_t unknown = i; unknown < power_.B.size(); unknown += elements_.size()) {
        bounds.power = std::max(bounds.power, area * power_.B[unknown]);
        bounds.H = std::min(bounds.H, power_.H[unknown]);
      }
    }
    return bounds;
  }

  [[nodiscard]] bool may_matter(const TileBounds& a, const TileBounds& b) const {
    if (options_.rule == FormFactor::points) return true;
    const double r2 = squared_gap(a, b);
    const double variances = a.variance + b.variance;
    // As moments_error, with all cosines 1.
    const double error = 5 * variances * variances * std::max(a.area, b.area);
    if (error > std::numbers::pi * r2 * r2 * r2 * kPairTolerance * options_.tolerance) return true;
    const double share = std::max(a.power / b.H, b.power / a.H);
    return options_.partial_visibility && share > std::numbers::pi * r2 * options_.tolerance;
  }

  void examine_tile(std::size_t row, std::size_t column, std::vector<Entry>& entries,
                    CorrectionCounts& counts) const {
    TileBits bits;
    store_.read(row, column, bits);
    for (std::size_t r = 0; r < rows_of_tile(row, elements_.size()); ++r) {
      const std::size_t i = row * kTileSize + r;
      for (std::size_t c = row == column ? r + 1 : 0; c < rows_of_tile(column, elements_.size()); ++c) {
        const std::size_t j = column * kTileSize + c;
        if (elements_[i].patch == elements_[j].patch) continue;
        examine_pair(std::min(i, j), std::max(i, j), (bits[r] >> c & 1u) != 0, entries, counts);
      }
    }
  }

  void examine_pair(std::size_t i, std::size_t j, bool sees, std::vector<Entry>& entries,
                    CorrectionCounts& counts) const {
    const PairRule rule = base_rule(options_.rule);
    if (options_.rule == FormFactor::points) {
      ++counts.near_pairs;
      add(i, j, sees, rule, examiner_.exchange_by_points(i, j, counts), entries);
      return;
    }
    const bool near = moments_error(elements_[i], elements_[j]) > kPairTolerance * options_.tolerance;
    if (!near && !significant(i, j)) return;
    if (near) ++counts.near_pairs;
    add(i, j, sees, rule, examiner_.exchange(i, j, near, sees, counts), entries);
  }

  /// Worth rays of its own though far: its share of the power, seen from the centroids, exceeds the
  /// tolerance.
  [[nodiscard]] bool significant(std::size_t i, std::size_t j) const {
    if (!options_.partial_visibility) return false;
    const Element &a = elements_[i], &b = elements_[j];
    const glm::vec3 separation = b.centroid - a.centroid;
    const std::uint32_t side_a = glm::dot(a.normal, separation) > 0 ? 0 : 1;
    const std::uint32_t side_b = glm::dot(b.normal, separation) < 0 ? 0 : 1;
    if ((a.sides >> side_a & 1u) == 0 || (b.sides >> side_b & 1u) == 0) return false;
    return power_.share(i + side_a * elements_.size(), j + side_b * elements_.size(),
                        pair_form_factor(PairRule::disc, a, b),
                        pair_form_factor(PairRule::disc, b, a)) > options_.tolerance;
  }

  /// Adds what the kernel's value lacks, in both directions.
  void add(std::size_t i, std::size_t j, bool sees, PairRule rule, const SideExchanges& exchanges,
           std::vector<Entry>& entries) const {
    const Element &a = elements_[i], &b = elements_[j];
    const glm::vec3 separation = b.centroid - a.centroid;
    const std::uint32_t seen_i = glm::dot(a.normal, separation) > 0 ? 0 : 1;
    const std::uint32_t seen_j = glm::dot(b.normal, separation) < 0 ? 0 : 1;
    const double of_kernel = sees ? static_cast<double>(a.area) * pair_form_factor(rule, a, b) : 0.0;
    bool kernel_done = !sees;
    for (const SideExchange& exchange : exchanges) {
      const bool same = exchange.side_i == seen_i && exchange.side_j == seen_j;
      add_entries(i, j, exchange.side_i, exchange.side_j, exchange.G - (same ? of_kernel : 0.0), entries);
      kernel_done = kernel_done || same;
    }
    if (!kernel_done) add_entries(i, j, seen_i, seen_j, -of_kernel, entries);
  }

  void add_entries(std::size_t i, std::size_t j, std::uint32_t side_i, std::uint32_t side_j, double G,
                   std::vector<Entry>& entries) const {
    // What changes neither row by a hundredth of what a pair may err by is not worth its bytes.
    const double least = static_cast<double>(std::min(elements_[i].area, elements_[j].area));
    if (std::abs(G) <= 0.01 * kPairTolerance * options_.tolerance * least) return;
    const auto row = static_cast<std::uint32_t>(i + side_i * elements_.size());
    const auto column = static_cast<std::uint32_t>(j + side_j * elements_.size());
    if (store_.owned().contains(i / kTileSize)) entries.push_back({row, column, static_cast<float>(G)});
    if (store_.owned().contains(j / kTileSize)) entries.push_back({column, row, static_cast<float>(G)});
  }

  PairExaminer examiner_;
  std::span<const Element> elements_;
  const TileStore& store_;
  const FormFactorOptions& options_;
  const PowerEstimate& power_;
  std::vector<TileBounds> bounds_;
};

Corrections compress(const std::vector<std::vector<Entry>>& parts, std::size_t unknowns) {
  Corrections result;
  result.start.assign(unknowns + 1, 0);
  for (const auto& part : parts)
    for (const Entry& entry : part) ++result.start[entry.row + 1];
  for (std::size_t row = 0; row < unknowns; ++row) result.start[row + 1] += result.start[row];
  std::vector<std::pair<std::uint32_t, float>> sorted(result.start.back());
  std::vector<std::uint64_t> next(result.start.begin(), result.start.end() - 1);
  for (const auto& part : parts)
    for (const Entry& entry : part) sorted[next[entry.row]++] = {entry.column, entry.G};
  result.column.reserve(sorted.size());
  result.G.reserve(sorted.size());
  for (std::size_t row = 0; row < unknowns; ++row) {
    const auto at = [&](std::uint64_t place) { return sorted.begin() + static_cast<std::ptrdiff_t>(place); };
    std::sort(at(result.start[row]), at(result.start[row + 1]));
  }
  for (const auto& [column, G] : sorted) {
    result.column.push_back(column);
    result.G.push_back(G);
  }
  return result;
}

}  // namespace

FoundCorrections find_corrections(const RayScene& ray_scene, const Scene& scene, const ElementMesh& mesh,
                                  const TileStore& store, const FormFactorOptions& options,
                                  const PowerEstimate& power, int threads) {
  FoundCorrections found;
  if (options.rule == FormFactor::point || options.rule == FormFactor::disc) return found;
  if (power.B.size() > std::numeric_limits<std::uint32_t>::max())
    throw std::length_error("more unknowns than 32 bits count");
  const TileExaminer examiner(ray_scene, scene, mesh, store, options, power);
  const TileRows rows = store.owned();
  std::vector<std::vector<Entry>> parts(rows.size());
  std::vector<CorrectionCounts> counts(rows.size());
  tbb::task_arena arena(threads);
  arena.execute([&] {
    tbb::parallel_for(std::size_t{0}, rows.size(),
                      [&](std::size_t k) { examiner.examine_row(rows.first + k, parts[k], counts[k]); });
  });
  for (const CorrectionCounts& count : counts) {
    found.counts.near_pairs += count.near_pairs;
    found.counts.partial_pairs += count.partial_pairs;
    found.counts.rays += count.rays;
  }
  found.corrections = compress(parts, power.B.size());
  return found;
}

}  // namespace fluxel
