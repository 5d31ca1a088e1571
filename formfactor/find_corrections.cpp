#include "formfactor/find_corrections.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <stdexcept>

#include "formfactor/contour_filter.hpp"
#include "formfactor/pair_rule.hpp"
#include "formfactor/tile_bounds.hpp"
#include "formfactor/visibility_probe.hpp"

namespace fluxel {

namespace {

struct Entry {
  std::uint32_t row, column;  // unknowns
  float G;
};

/// The sides (0 front, 1 back) that the centroids of two elements show each other.
struct FacingSides {
  std::uint32_t i, j;
};

FacingSides facing_sides(const Element& i, const Element& j) {
  const glm::vec3 separation = j.centroid - i.centroid;
  return {glm::dot(i.normal, separation) > 0 ? 0u : 1u, glm::dot(j.normal, separation) < 0 ? 0u : 1u};
}

/// The bits that differ from one beside them, and the aligned 4 x 4 blocks that are not all one value: four
/// elements in a row are a node of a patch's tree more often than not. Elsewhere no edge of a shadow is near.
TileBits shadow_edges(const TileBits& bits) {
  constexpr std::uint64_t kFirstOfFour = 0x1111111111111111ull, kLast = std::uint64_t{1} << 63;
  TileBits edges;
  for (std::size_t r = 0; r < kTileSize; r += 4) {
    const std::uint64_t any_row = bits[r] | bits[r + 1] | bits[r + 2] | bits[r + 3];
    const std::uint64_t all_rows = bits[r] & bits[r + 1] & bits[r + 2] & bits[r + 3];
    const std::uint64_t any = (any_row | any_row >> 1 | any_row >> 2 | any_row >> 3) & kFirstOfFour;
    const std::uint64_t all = (all_rows & all_rows >> 1 & all_rows >> 2 & all_rows >> 3) & kFirstOfFour;
    for (std::size_t k = 0; k < 4; ++k) edges[r + k] = (any & ~all) * 0xF;
  }
  for (std::size_t r = 0; r < kTileSize; ++r) {
    const std::uint64_t row = bits[r];
    edges[r] |= row ^ (row << 1 | (row & 1));
    edges[r] |= row ^ (row >> 1 | (row & kLast));
    if (r > 0) edges[r] |= row ^ bits[r - 1];
    if (r + 1 < kTileSize) edges[r] |= row ^ bits[r + 1];
  }
  return edges;
}

/// Finds the corrections of one tile row after another.
class TileExaminer {
 public:
  TileExaminer(const RayScene& ray_scene, const Scene& scene, const ElementView& mesh, const TileStore& store,
               const FormFactorOptions& options, const PowerEstimate& power)
      : ray_scene_(ray_scene),
        mesh_(mesh),
        examiner_(ray_scene, scene, mesh, options, power),
        elements_(mesh.elements),
        store_(store),
        options_(options),
        power_(power),
        pair_tolerance_(kPairTolerance * options.tolerance),
        filter_(elements_, pair_tolerance_, kCrossingShare * pair_tolerance_) {
    for (std::size_t tile = 0; tile < store.tiles(); ++tile) {
      shapes_.push_back(tile_shape(elements_, tile));
      powers_.push_back(tile_power(elements_, tile, power));
    }
  }

  void examine_row(std::size_t row, std::vector<Entry>& entries, CorrectionCounts& counts) const {
    for (std::size_t column = 0; column < store_.tiles(); ++column) {
      // A pair with both rows here is found once, by the lower tile.
      if (column < row && store_.owned().contains(column)) continue;
      const bool near =
          options_.rule == FormFactor::points || may_be_near(shapes_[row], shapes_[column], pair_tolerance_);
      const double share = options_.partial_visibility
                               ? largest_share(shapes_[row], powers_[row], shapes_[column], powers_[column]) /
                                     options_.tolerance
                               : 0;
      const TileWork work{near, share > kMiddleShare,
                          share > kSmallShare && store_.tag(row, column) == TileTag::bits};
      if (work.near || work.large || work.small) examine_tile(row, column, work, entries, counts);
    }
  }

 private:
  /// Which pairs of a tile are looked at: those that may be near; all, where shares are so large that a pair
  /// deserves rays wherever it is; those at the edges of shadows, where shares are large enough for that.
  struct TileWork {
    bool near, large, small;
  };

  void examine_tile(std::size_t row, std::size_t column, const TileWork& work, std::vector<Entry>& entries,
                    CorrectionCounts& counts) const {
    VisibilityProbe probe(ray_scene_, mesh_);
    TileBits bits;
    store_.read(row, column, bits);
    const TileBits edges = work.small ? shadow_edges(bits) : TileBits{};
    for (std::size_t r = 0; r < rows_of_tile(row, elements_.size()); ++r) {
      const std::size_t i = row * kTileSize + r;
      const std::uint64_t near = work.near ? near_candidates(i, column) : 0;
      if (near == 0 && !work.large && edges[r] == 0) continue;
      for (std::size_t c = row == column ? r + 1 : 0; c < rows_of_tile(column, elements_.size()); ++c) {
        if (!work.large && ((near | edges[r]) >> c & 1u) == 0) continue;
        const std::size_t j = column * kTileSize + c;
        if (elements_[i].patch == elements_[j].patch) continue;
        const PairBit pair{std::min(i, j), std::max(i, j), (bits[r] >> c & 1u) != 0};
        if ((near >> c & 1u) != 0 && examine_near(pair, entries, counts)) continue;
        const bool at_edge = (edges[r] >> c & 1u) != 0;
        if (!work.large && !at_edge) continue;
        const double share = share_of(pair) / options_.tolerance;
        if (share > kLargeShare) {
          add(pair, examiner_.exchange(pair.i, pair.j, false, pair.sees, counts), entries);
        } else if (share > (at_edge ? kSmallShare : kMiddleShare)) {
          probe.add(pair);
        }
      }
    }
    probe.finish();
    counts.rays += probe.rays();
    for (const PairBit& pair : probe.doubtful())
      add(pair, examiner_.exchange(pair.i, pair.j, false, pair.sees, counts), entries);
  }

  [[nodiscard]] std::uint64_t near_candidates(std::size_t i, std::size_t tile) const {
    return options_.rule == FormFactor::points ? ~std::uint64_t{0} : filter_.candidates(i, tile);
  }

  [[nodiscard]] bool needs_contour(const Element& i, const Element& j) const {
    const FlatShape a = flat_shape(i), b = flat_shape(j);
    return moments_error(a, b) > pair_tolerance_ || crossing_error(a, b) > kCrossingShare * pair_tolerance_;
  }

  /// True where the pair is one whose form factor the kernel cannot make.
  bool examine_near(const PairBit& pair, std::vector<Entry>& entries, CorrectionCounts& counts) const {
    if (options_.rule == FormFactor::points) {
      add(pair, examiner_.exchange_by_points(pair.i, pair.j, counts), entries);
    } else if (needs_contour(elements_[pair.i], elements_[pair.j])) {
      add(pair, examiner_.exchange(pair.i, pair.j, true, pair.sees, counts), entries);
    } else {
      return false;
    }
    ++counts.near_pairs;
    return true;
  }

  /// Of the power, seen from the centroids; 0 where no unknown sides face each other there.
  [[nodiscard]] double share_of(const PairBit& pair) const {
    const Element &a = elements_[pair.i], &b = elements_[pair.j];
    const FacingSides sides = facing_sides(a, b);
    if ((a.sides >> sides.i & 1u) == 0 || (b.sides >> sides.j & 1u) == 0) return 0;
    const double F = pair_form_factor(PairRule::disc, a, b);
    return power_.share(pair.i + sides.i * elements_.size(), pair.j + sides.j * elements_.size(), F,
                        F * static_cast<double>(a.area) / static_cast<double>(b.area));
  }

  /// Adds what the kernel's value lacks, in both directions.
  void add(const PairBit& pair, const SideExchanges& exchanges, std::vector<Entry>& entries) const {
    const Element &a = elements_[pair.i], &b = elements_[pair.j];
    const FacingSides seen = facing_sides(a, b);
    const PairRule rule =
        rule_between(shapes_[pair.i / kTileSize], shapes_[pair.j / kTileSize], kernel_rule(options_));
    const double of_kernel = pair.sees ? static_cast<double>(a.area) * pair_form_factor(rule, a, b) : 0.0;
    bool kernel_done = !pair.sees;
    for (const SideExchange& exchange : exchanges) {
      const bool same = exchange.side_i == seen.i && exchange.side_j == seen.j;
      add_entries(pair, exchange.side_i, exchange.side_j, exchange.G - (same ? of_kernel : 0.0), entries);
      kernel_done = kernel_done || same;
    }
    if (!kernel_done) add_entries(pair, seen.i, seen.j, -of_kernel, entries);
  }

  void add_entries(const PairBit& pair, std::uint32_t side_i, std::uint32_t side_j, double G,
                   std::vector<Entry>& entries) const {
    const auto [i, j, sees] = pair;
    // What changes neither row by a hundredth of what a pair may err by is not worth its bytes.
    const double least = static_cast<double>(std::min(elements_[i].area, elements_[j].area));
    if (std::abs(G) <= 0.01 * pair_tolerance_ * least) return;
    const auto row = static_cast<std::uint32_t>(i + side_i * elements_.size());
    const auto column = static_cast<std::uint32_t>(j + side_j * elements_.size());
    if (store_.owned().contains(i / kTileSize)) entries.push_back({row, column, static_cast<float>(G)});
    if (store_.owned().contains(j / kTileSize)) entries.push_back({column, row, static_cast<float>(G)});
  }

  /// Of the power, in tolerances: full sets of rays at once; probes everywhere; probes where the bits show
  /// the edge of a shadow. Many small shares at one shadow's edge err alike: hence the last is less than one.
  static constexpr double kLargeShare = 30, kMiddleShare = 10, kSmallShare = kLeastShare;

  const RayScene& ray_scene_;
  ElementView mesh_;
  PairExaminer examiner_;
  std::span<const Element> elements_;
  const TileStore& store_;
  const FormFactorOptions& options_;
  const PowerEstimate& power_;
  double pair_tolerance_;
  ContourFilter filter_;
  std::vector<TileShape> shapes_;
  std::vector<TilePower> powers_;
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

FoundCorrections find_corrections(const RayScene& ray_scene, const Scene& scene, const ElementView& mesh,
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
